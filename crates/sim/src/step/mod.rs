//! One step of a run: sense, communicate, decide, act, judge. [`tick`] is the table of contents.

mod act;
mod acts;
mod agent_events;
mod clearance;
pub(crate) mod communicate;
mod convoy;
mod decide;
mod decision;
mod decision_hash;
pub(crate) mod delegated;
mod destination;
pub(crate) mod direct;
mod encounters;
pub(crate) mod external;
mod external_contacts;
mod flock_step;
mod flock_sums;
mod flocks;
mod hazards;
mod measurement;
pub(crate) mod mixed_percept;
pub(crate) mod neighbours;
mod parallel;
mod passage;
pub(crate) mod pending_decisions;
mod plan;
pub(crate) mod robot_scene;
mod sense;
mod sensing_place;
mod surroundings;
pub(crate) mod tick;
pub(crate) mod view;

pub use external::ExternalInputs;
pub use mixed_percept::Perceived;
pub use pending_decisions::PendingDecision;
