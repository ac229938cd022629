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
    /// The range of the remaining time; null if it is unknown.
    pub remaining_s: Option<(f64, f64)>,
    /// At most 50 configurations: the best of those that remain; with a requirement, all that have runs,
    /// the cheapest first.
    pub standings: Vec<Standing>,
    /// The eliminations in order: configuration, the one that eliminated it if one did, its number of runs.
    /// With a requirement, these are the refuted ones.
    pub eliminated: Vec<(u32, Option<u32>, u64)>,
    /// The number of certified configurations; null without a requirement.
    pub certified: Option<u64>,
    /// The labels of all configurations; in the first message only.
    pub labels: Option<Vec<String>>,
}

/// What is known of a configuration in a study of a requirement.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub enum RequirementStatus {
    /// It meets the requirement.
    #[serde(rename = "certified")]
    Certified,
    /// It does not meet it with tolerance to spare.
    #[serde(rename = "refuted")]
    Refuted,
    /// It does not meet it with tolerance to spare; without, it may.
    #[serde(rename = "may meet")]
    MayMeet,
    /// Neither is shown.
    #[serde(rename = "open")]
    Open,
    /// Neither is shown, and one that is not dearer is certified.
    #[serde(rename = "not needed")]
    NotNeeded,
}

/// A configuration: index, runs, merit, the bounds of its confidence interval, null before they are
/// computed, and its status, null without a requirement. With one, the merit is the share of runs that
/// meet it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Standing(
    pub u32,
    pub u64,
    pub Option<f64>,
    pub Option<f64>,
    pub Option<f64>,
    pub Option<RequirementStatus>,
);
