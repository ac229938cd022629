//! Studies in the list, and one with its answer.

use crate::lists::Engine;
use crate::page::Json;
use crate::study::StudyState;
use crate::study_form::StudyPlan;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A study in the list.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudySummary {
    /// Its id: its folder.
    pub id: String,
    /// The name of its scenario.
    pub name: String,
    /// The simulator that runs it; null if the study is damaged.
    pub engine: Option<Engine>,
    /// Its state.
    pub state: StudyState,
    /// What it compares, in one sentence.
    pub words: String,
    /// The number of configurations.
    pub configurations: u64,
    /// The number of runs so far.
    pub runs: u64,
    /// The confidence.
    pub confidence: f64,
    /// The indifference zone; null with a requirement.
    pub delta: Option<f64>,
    /// The answer in one sentence, if there is one.
    pub sentence: Option<String>,
    /// Whether the answer recommends a configuration without reservation; null without an answer.
    pub is_recommended: Option<bool>,
    /// What is wrong, if anything is.
    pub message: Option<String>,
    /// The time of the last change, in seconds since 1970.
    pub changed_s: f64,
}

/// All studies.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyList {
    /// The newest first.
    pub studies: Vec<StudySummary>,
}

/// The scenario of a study.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudySource {
    /// Its id in the gallery; null if it has changed or is gone.
    pub scenario: Option<String>,
}

/// A study with its plan and its answer.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Study {
    /// What the list contains.
    #[serde(flatten)]
    pub summary: StudySummary,
    /// What it compares.
    pub planned: StudyPlan,
    /// Its scenario.
    pub source: StudySource,
    /// Its answer, if it has one.
    pub answer: Option<StudyAnswer>,
}

/// The answer of a study, with the sections of its report.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyAnswer {
    /// What to send, how it does, what is known of the others, and what is not distinguished.
    pub verdict: (String, String, String, String),
    /// The answer in one sentence.
    pub sentence: String,
    /// The guarantee.
    pub guarantee: String,
    /// Key numbers, each with its label.
    pub facts: Vec<(String, String)>,
    /// A warning about quarantined runs; empty if there are none.
    pub quarantined: String,
    /// The sections of the report.
    pub sections: Vec<StudySection>,
    /// The Vega-Lite specifications of the charts, by name.
    pub charts: BTreeMap<String, BTreeMap<String, Json>>,
    /// The results, by configuration.
    pub results: Vec<StudyResult>,
}

/// A section of the report.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudySection {
    /// Its id in the page.
    pub id: String,
    /// Its title.
    pub title: String,
    /// Explanations, a paragraph each.
    pub words: Vec<String>,
    /// The names of its charts.
    pub charts: Vec<String>,
    /// The caption of each chart.
    pub captions: BTreeMap<String, String>,
    /// Its tables.
    pub tables: Vec<StudyTable>,
    /// Whether its tables are initially closed.
    pub folded: bool,
}

/// A table of the report.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyTable {
    /// Its caption.
    pub caption: String,
    /// The titles of its columns.
    pub head: Vec<String>,
    /// The cells of each row.
    pub rows: Vec<Vec<String>>,
    /// The configuration of each row; null if it has none.
    pub configurations: Vec<Option<u32>>,
}

/// The result of a configuration.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StudyResult {
    /// The configuration.
    pub configuration: u32,
    /// Its label.
    pub label: String,
    /// The number of its runs.
    pub runs: u64,
    /// What is known of it.
    pub verdict: StudyVerdict,
    /// Whether it was eliminated; with a requirement, refuted.
    pub eliminated: bool,
    /// The share of runs that meet the requirement, with its interval; null without one, and without runs.
    pub met: Option<(f64, f64, f64)>,
}

/// What is known of a configuration: by merit from `best` to `worse`, with a requirement `best` for the
/// selected one and the status of the others.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub enum StudyVerdict {
    /// It is selected.
    #[serde(rename = "best")]
    Best,
    /// It differs from the selected one by at most delta.
    #[serde(rename = "tied")]
    Tied,
    /// It is not better than the selected one by more than delta.
    #[serde(rename = "not better")]
    NotBetter,
    /// None of the others is shown.
    #[serde(rename = "undecided")]
    Undecided,
    /// Its mean merit is lower than that of the selected one.
    #[serde(rename = "worse")]
    Worse,
    /// It cannot be run.
    #[serde(rename = "impossible")]
    Impossible,
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
