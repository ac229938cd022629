//! The messages between the server and the page, as types only.
//!
//! Messages are JSON on a WebSocket, each with its `type`; frames and overlays are binary. Requests
//! and answers about studies are JSON over HTTP. The JSON Schema of these types ([`page_schema`]) and
//! that of brains ([`brain_schema`]) are the source of the Python types of the server and of the
//! TypeScript types of the page. Its schema also has the answers of a drive's warden to pages.
//!
//! Seeds and run numbers can have 64 bits, which JavaScript numbers cannot hold: they are strings.

mod lists;
mod page;
mod schema;
mod server;
mod setting;
mod shown;
mod study;
mod study_answer;
mod study_form;
mod timeline;
mod warden;

pub use lists::{
    Checked, Deleted, Engine, InputError, LibraryEntry, LibraryList, Origin, RecordedRun,
    RecordingEntry, ScenarioEntry,
};
pub use page::{
    Acknowledge, Change, Chart, ChooseVersion, Empty, Json, LoggedChange, Open, PageMessage, Play,
    Seek, Select, SeriesRequest, Show, Step, StudyMember,
};
pub use schema::{brain_schema, page_schema};
pub use server::{
    Ended, Exported, Inspection, MapPart, Opened, OpenedRecording, OpenedScenario, Refused,
    RobotView, Saved, Saving, ServerMessage, State,
};
pub use setting::{ItemView, KindView, MapView, RingView, SensorView, Setting, Unit, WorldView};
pub use shown::{EventKind, Layer, Offer, Panel, Shown, SignalOffer};
pub use study::{RequirementStatus, Standing, StudyProgress, StudyState};
pub use study_answer::{
    Study, StudyAnswer, StudyList, StudyResult, StudySection, StudySource, StudySummary,
    StudyTable, StudyVerdict,
};
pub use study_form::{
    ChangedScenario, ChangedValue, Factor, Factors, Guarantee, PlannedFactor, PlannedRequirement,
    Requirement, StudyPlan, StudyQuestion, StudyRequest,
};
