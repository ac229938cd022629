//! The form of a study: what can be varied, what is requested, and what that would compare.

use crate::lists::Engine;
use crate::study::StudyState;
use base::document::schema::{ParameterKind, ParameterValue};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A number or choice of a scenario that a study can vary.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Factor {
    /// Its keys from the root, separated by dots.
    pub path: String,
    /// Its value; null if the scenario does not set it.
    pub value: Option<ParameterValue>,
    /// The lower bound, if any.
    pub low: Option<f64>,
    /// The upper bound, if any.
    pub high: Option<f64>,
    /// The kind of its values.
    pub kind: ParameterKind,
    /// The choices; null if it is a number.
    pub values: Option<Vec<ParameterValue>>,
    /// The unit, if any.
    pub unit: Option<String>,
    /// The description.
    pub help: String,
    /// The scenario's own range, such as `1..8`.
    pub varied: Option<String>,
}

/// What a mission must meet, and in which share of missions.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Requirement {
    /// All of this in one sentence.
    pub words: String,
    /// A mission meets the requirement if all hold.
    pub conditions: Vec<String>,
    /// The required share of missions.
    pub probability: f64,
    /// Shares from the probability to this much above it are not distinguished.
    pub tolerance: f64,
}

/// What a study of a scenario can be about.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Factors {
    /// The name of the scenario.
    pub name: String,
    /// The simulator that runs it.
    pub engine: Engine,
    /// Its summary.
    pub summary: String,
    /// What can be varied, team sizes first.
    pub factors: Vec<Factor>,
    /// The design.
    pub design: String,
    /// The names of the built-in figures of merit.
    pub merits: Vec<String>,
    /// The name of the scenario's own.
    pub merit: String,
    /// The indifference zone; null if it is derived from the merit.
    pub delta: Option<f64>,
    /// The confidence.
    pub confidence: f64,
    /// The requirement of the scenario, if any.
    pub requirement: Option<Requirement>,
    /// Columns that conditions can be about.
    pub columns: Vec<String>,
    /// The quantity to be minimal in a study with a requirement.
    pub minimize: String,
    /// Limits the combinations; null if all are compared.
    #[serde(rename = "where")]
    pub only_where: Option<String>,
    /// The scenario that a run was exported from; null for all other scenarios.
    pub exported_from: Option<ChangedScenario>,
}

/// The scenario of a run, with what was changed in it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChangedScenario {
    /// Its name.
    pub name: String,
    /// The first changed values.
    pub values: Vec<ChangedValue>,
    /// The number of all changed values.
    pub total: u32,
}

/// A value of a scenario that was changed.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChangedValue {
    /// Its keys from the root, separated by dots.
    pub path: String,
    /// The value before, as in the file; null if the scenario does not have it.
    pub old: Option<String>,
    /// The value now, as in the file; null if it was removed.
    pub new: Option<String>,
}

/// What a study is about.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StudyQuestion {
    /// The best by merit.
    Merit,
    /// The cheapest that meets a requirement.
    Requirement,
}

/// The guarantee of a study of the best by merit.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Guarantee {
    /// The best is selected if it is better by delta.
    Indifference,
    /// The selected one is within delta of the best.
    Pgs,
}

/// A study that the page requests; parts that belong to the other question are null.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyRequest {
    /// A scenario by its id in the gallery; this or `text` is null.
    pub scenario: Option<String>,
    /// The text of a scenario, TOML.
    pub text: Option<String>,
    /// What the study is about.
    pub question: StudyQuestion,
    /// The conditions; null for those of the scenario.
    pub require: Option<Vec<String>>,
    /// The required share of missions; null for that of the scenario.
    pub probability: Option<f64>,
    /// The tolerance; null for that of the scenario.
    pub tolerance: Option<f64>,
    /// The quantity to be minimal; null for that of the scenario.
    pub minimize: Option<String>,
    /// Limits the combinations; null for the limit of the scenario.
    #[serde(rename = "where")]
    pub only_where: Option<String>,
    /// Values by path; empty for those of the scenario.
    pub vary: BTreeMap<String, String>,
    /// The design; null for that of the scenario.
    pub design: Option<String>,
    /// The indifference zone; null for that of the scenario.
    pub delta: Option<f64>,
    /// The confidence; null for that of the scenario.
    pub confidence: Option<f64>,
    /// The guarantee; null for indifference.
    pub guarantee: Option<Guarantee>,
    /// The name of a figure of merit; null for that of the scenario.
    pub merit: Option<String>,
    /// The same number of runs for all configurations; null for as few as needed.
    pub runs: Option<u64>,
    /// The maximum number of runs.
    pub max_runs: Option<u64>,
    /// The seed as a decimal number.
    pub seed: String,
}

/// A factor of a planned study; it has either values or a range.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlannedFactor {
    /// Its keys from the root, separated by dots.
    pub path: String,
    /// Its values; empty if it has a range.
    pub values: Vec<ParameterValue>,
    /// The ends of its range.
    pub range: Option<(f64, f64)>,
}

/// The requirement of a planned study.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlannedRequirement {
    /// The requirement.
    #[serde(flatten)]
    pub requirement: Requirement,
    /// The quantity to be minimal.
    pub minimize: String,
}

/// What a study compares.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyPlan {
    /// The id of the study: its folder.
    pub id: String,
    /// The name of the scenario.
    pub name: String,
    /// The number of configurations.
    pub configurations: u64,
    /// The labels of the first configurations.
    pub labels: Vec<String>,
    /// All of this in one sentence.
    pub words: String,
    /// The indifference zone; null with a requirement.
    pub delta: Option<f64>,
    /// The confidence.
    pub confidence: f64,
    /// The guarantee; null with a requirement.
    pub guarantee: Option<Guarantee>,
    /// The requirement, if there is one.
    pub requirement: Option<PlannedRequirement>,
    /// The name of the figure of merit.
    pub merit: String,
    /// The varied factors.
    pub factors: Vec<PlannedFactor>,
    /// The state of the study that exists in this folder; null if there is none.
    pub state: Option<StudyState>,
}
