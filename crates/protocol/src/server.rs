//! Messages from the server to the page of a run.

use crate::lists::{Engine, InputError, RecordingEntry};
use crate::page::Json;
use crate::setting::Setting;
use crate::shown::Shown;
use crate::study::StudyProgress;
use crate::timeline::{Events, Series, Signals};
use base::geometry::Point;
use brain::{BeliefState, Command, Percept};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A message of the server.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ServerMessage {
    /// A run is open.
    Opened(Opened),
    /// The setting in which frames are drawn; sent whenever the scenario has changed.
    Setting(Box<Setting>),
    /// The state of the run, with a maximum rate of 10 Hz.
    State(Box<State>),
    /// The belief map of the selected robot, with a maximum rate of 4 Hz.
    Map(MapPart),
    /// The layers and panels that the page has requested, with a maximum rate of 4 Hz.
    Shown(Shown),
    /// The progress of saving a recording.
    Saving(Saving),
    /// A recording has been saved or cancelled.
    Saved(Saved),
    /// The scenario as it is now.
    Exported(Exported),
    /// The outcome over time.
    Series(Series),
    /// What has happened.
    Events(Events),
    /// The requested signals.
    Signals(Signals),
    /// A message was refused; it changed nothing.
    Refused(Refused),
    /// The server is about to disconnect.
    Ended(Ended),
    /// The progress of a study.
    StudyProgress(StudyProgress),
}

/// A run that has been opened.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Opened {
    /// Its scenario.
    pub scenario: OpenedScenario,
    /// The seed as a decimal number.
    pub seed: String,
    /// The number of the run as a decimal number.
    pub run: String,
    /// The recording that it was opened from, if any.
    pub recording: Option<OpenedRecording>,
    /// Whether it is the live run of the server.
    pub is_live: bool,
}

/// The scenario of an opened run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OpenedScenario {
    /// Its id in the gallery, if it was opened by that.
    pub id: Option<String>,
    /// Its name.
    pub name: String,
    /// The simulator that runs it.
    pub engine: Engine,
    /// Its summary.
    pub summary: String,
    /// The time limit of a run.
    pub time_limit_s: f64,
}

/// The recording of an opened run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OpenedRecording {
    /// Its id.
    pub id: String,
    /// The version and the engine that recorded it.
    pub recorded_by: String,
    /// The version and the engine of the server.
    pub replayed_by: String,
    /// Whether it was still being written when it was opened.
    pub is_being_written: bool,
}

/// The state of a run at one step.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct State {
    /// The current tick.
    pub tick: u64,
    /// The last tick that was reached or recorded.
    pub latest_tick: u64,
    /// The simulated time.
    pub time_s: f64,
    /// A hash of the state: 16 hexadecimal digits.
    pub hash: String,
    /// Whether the run is playing.
    pub is_playing: bool,
    /// The requested speed as a multiple of real time; null for as fast as possible.
    pub speed: Option<f64>,
    /// The measured speed as a multiple of real time.
    pub measured_speed: f64,
    /// The tick that the run is moving to; null unless it is seeking one.
    pub target_tick: Option<u64>,
    /// Whether the run is over.
    pub is_over: bool,
    /// The first tick at which the run was found to differ from its recording.
    pub mismatch_tick: Option<u64>,
    /// The outcome if the run ended now: values by column.
    pub outcome: BTreeMap<String, Json>,
    /// The inspection of the selected robot; null if there is no such robot.
    pub inspection: Option<Inspection>,
    /// Further details of the selected robot.
    pub robot: Option<RobotView>,
}

/// The percept and the decision of a robot in its last step, and its beliefs.
///
/// All but `belief_state` is null if its brain has not stepped since it was selected.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Inspection {
    /// The name of the robot, KIND/INDEX.
    pub robot: String,
    /// The tick before that step.
    pub tick: Option<u64>,
    /// The percept.
    pub percept: Option<Percept>,
    /// The command.
    pub command: Option<Command>,
    /// The index of the active behaviour; null if none is, or if all are blended.
    pub leading: Option<u32>,
    /// Remaining hold time of each behaviour.
    pub holds_s: Option<Vec<f64>>,
    /// Its belief state; null if it has no beliefs.
    pub belief_state: Option<BeliefState>,
}

/// A part of the belief map of a robot: a rectangle of cells; all others have not changed. The
/// first part of a robot contains all cells.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MapPart {
    /// The name of the robot, KIND/INDEX.
    pub robot: String,
    /// The lower left corner of the map.
    pub corner: Point,
    /// The side of a cell.
    pub cell_m: f64,
    /// Columns of the map.
    pub columns: u32,
    /// Rows of the map.
    pub rows: u32,
    /// The first column and row of the rectangle.
    pub from: [u32; 2],
    /// Columns and rows of the rectangle.
    pub size: [u32; 2],
    /// Base64 of one byte per cell, the lowest row first: 0 to 100 percent occupied, 255 unknown.
    pub occupancy: String,
    /// Base64 of one byte per cell: probability in percent that an item there was not detected.
    pub unseen: String,
}

/// Details of a robot as labelled strings.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RobotView {
    /// The name of the robot, KIND/INDEX.
    pub name: String,
    /// Labels and values.
    pub facts: Vec<[String; 2]>,
    /// Outlines of the cells that it would examine if it decided now.
    pub examined_cells: Vec<Vec<Point>>,
}

/// The progress of saving a recording.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Saving {
    /// Saved steps.
    pub done: u64,
    /// Total number of steps.
    pub steps: u64,
}

/// A recording that has been saved.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Saved {
    /// The recording; null if it was cancelled.
    pub recording: Option<RecordingEntry>,
}

/// A scenario as a file.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Exported {
    /// Its text, TOML.
    pub text: String,
}

/// A message that was refused.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Refused {
    /// The type of the message.
    pub about: String,
    /// The path of a refused change.
    pub path: Option<String>,
    /// The first errors.
    pub errors: Vec<InputError>,
    /// The number of all errors.
    pub total: u32,
}

/// Why the server disconnects.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Ended {
    /// `idle` or `full`.
    pub reason: String,
    /// The reason as a sentence.
    pub message: String,
}
