//! The timeline of a run: what has happened, the versions that changes have made, and numbers over time.

use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// What has happened in a run, in order. Changes are not among it: they are in the setting.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Events {
    /// The first tick that the rows are about: they replace all rows from here on.
    pub since: u64,
    /// The events.
    pub rows: Vec<EventRow>,
    /// Kinds with very many events: of how many one is listed.
    pub one_of: BTreeMap<String, u64>,
}

/// Something that happened.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct EventRow {
    /// The number of steps before the step in which it happened.
    pub tick: u64,
    /// The id of its kind.
    pub kind: String,
    /// The name of the item, goal, robot, controller or vehicle that it happened to.
    pub of: String,
    /// What happened.
    pub text: String,
    /// The name of the robot or controller that did it; empty if there is none.
    pub agent: String,
}

/// A run with some changes. The versions of a run are a tree, through which undo and redo move.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct VersionView {
    /// Its number.
    pub number: u64,
    /// The version in which its last change was made; null of the first.
    pub parent: Option<u64>,
    /// The tick of that change.
    pub tick: u64,
    /// The path of that change; empty of the first version.
    pub path: String,
    /// The value of that change, as in JSON, at most 60 characters.
    pub value: String,
    /// The last tick that was reached or recorded.
    pub latest_tick: u64,
}

/// The requested signals, sampled from the run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "the page calls them so")]
pub struct Signals {
    /// Their ids, in the order of the values.
    pub signals: Vec<String>,
    /// The first tick that the rows are about: they replace all rows from here on.
    pub since: u64,
    /// The tick up to which the run was sampled.
    pub until: u64,
    /// Ticks from one sample to the next.
    pub every: u64,
    /// The samples; a value is null where there is none.
    pub rows: Vec<SeriesRow>,
}

/// The outcome over time: a row wherever a count changed, and evenly spaced ones.
///
/// Of very many changes, only some are kept; items found are kept longest.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Series {
    /// The first tick that the rows are about: they replace all rows from here on.
    pub since: u64,
    /// The columns with numbers.
    pub columns: Vec<String>,
    /// The rows by tick.
    pub rows: Vec<SeriesRow>,
}

/// The outcome at a tick, if the run had ended there.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SeriesRow {
    /// The tick.
    pub tick: u64,
    /// A value per column; null where there is none.
    pub values: Vec<Option<f64>>,
}
