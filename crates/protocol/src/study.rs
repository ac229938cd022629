//! The progress of a study, with a maximum rate of 5 Hz until the study ends.

use schemars::JsonSchema;
use serde::Serialize;

/// The state of a study.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StudyState {
    /// Runs are being computed.
    Running,
    /// It has an answer.
    Answered,
    /// It was stopped before it had an answer.
    Stopped,
    /// Its folder cannot be read.
    Damaged,
}

/// The progress of a study.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyProgress {
    /// Its state.
    pub state: StudyState,
    /// The error that stopped it, if any.
    pub message: Option<String>,
    /// Completed rounds.
    pub rounds: u64,
    /// Completed runs.
    pub runs: u64,
    /// Runs computed since the study was started or resumed.
    pub computed: u64,
    /// Time since then.
    pub seconds: f64,
    /// The rate of computation.
    pub runs_per_s: f64,
    /// Configurations that remain.
    pub remaining: u64,
    /// Estimated remaining runs.
    pub remaining_runs: Option<u64>,
    /// Estimated remaining time.
    pub remaining_s: Option<f64>,
    /// The best of the remaining configurations, at most 50.
    pub standings: Vec<Standing>,
    /// The eliminations in order: configuration, the one that eliminated it, its number of runs.
    pub eliminated: Vec<(u32, u32, u64)>,
    /// The labels of all configurations; in the first message only.
    pub labels: Option<Vec<String>>,
}

/// A remaining configuration: index, runs, merit, and the bounds of its confidence interval, null
/// before they are computed.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Standing(
    pub u32,
    pub u64,
    pub Option<f64>,
    pub Option<f64>,
    pub Option<f64>,
);
