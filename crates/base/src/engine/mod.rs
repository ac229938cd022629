//! The seam between simulators and studies.
//!
//! An [`Engine`] describes a simulator: the scenario keys that it reads, what a study can vary, and
//! what a figure of merit can weigh. It reads a scenario into a [`Configuration`], whose [`Runner`]
//! computes blocks of runs.

mod column;
mod merit_term;
mod outcome_column;
mod runner;

pub use column::{Bounds, Column, ColumnKind};
pub use merit_term::{MeritTerm, NamedMerit};
pub use outcome_column::{OutcomeColumn, OutcomeColumns};
pub use runner::{BlockOptions, Runner};

use crate::document::{Document, Value};
use crate::error::InputErrors;
use crate::scenario::condition::ConditionColumns;
use crate::warning::Warning;

/// Largest time limit of a run, in seconds.
pub const MAX_TIME_LIMIT_S: f64 = 1e6;

/// A simulator, as scenarios see it.
///
/// The keys `engine`, `summary`, `merit`, `study` and `published` are common to all engines and read
/// by [`crate::scenario`]; each engine reads the others itself.
pub trait Engine: Sync {
    /// Its name, as in `engine = "classic"`.
    fn name(&self) -> &'static str;

    /// The keys at the root of a scenario that this engine reads.
    fn keys(&self) -> &'static [&'static str];

    /// Reads its own keys and ignores the others.
    ///
    /// # Errors
    /// Everything that is wrong with the values of its keys.
    fn read(&self, document: &Document) -> Result<Configuration, InputErrors>;

    /// Warnings about configurations of a document: what is allowed there, and probably not meant. Each
    /// configuration has values by path. Invalid configurations have none.
    fn warnings(
        &self,
        _document: &Document,
        _configurations: &[Vec<(String, Value)>],
    ) -> Vec<Warning> {
        Vec::new()
    }

    /// Quantities that follow from the values of a document and help to check it, as (name, description). An
    /// invalid document has none.
    fn derived(&self, _document: &Document) -> Vec<(String, String)> {
        Vec::new()
    }

    /// The files that a document refers to and that have not been read yet: see [`Document::open`].
    /// Once they are read, there may be more. Called on documents with errors, too.
    fn files(&self, _document: &Document) -> Vec<String> {
        Vec::new()
    }

    /// The terms that a figure of merit can weigh, in the order of summation. Called on documents
    /// with errors, too.
    fn merit_terms(&self, document: &Document) -> Vec<MeritTerm>;

    /// The outcome columns that conditions can refer to: the names of [`Runner::columns`], and those of them that
    /// are times until a count reached a number. They are the same for every configuration of a study. Called on
    /// documents with errors, too.
    fn condition_columns(&self, document: &Document) -> ConditionColumns;

    /// The predefined figures of merit.
    fn merits(&self) -> &'static [NamedMerit];

    /// The paths that a study can vary, in the order in which it varies them. `None` for any path
    /// under the engine's keys at which [`Engine::read`] accepts a number, a boolean or a string.
    fn factors(&self) -> Option<&'static [&'static str]>;

    /// The names in the table at `path`, if its keys are names that the user chooses (as in
    /// `[robots.NAME]`), whether or not the table exists. Called on documents with errors, too.
    fn names(&self, document: &Document, path: &[&str]) -> Option<Vec<String>>;

    /// Maximum team size.
    fn max_robots(&self) -> u32;
}

/// What an engine reads from a scenario.
pub struct Configuration {
    /// Ready to be run.
    pub runner: Box<dyn Runner>,
    /// Number of robots of each kind.
    pub robots: Vec<(String, u32)>,
    /// Time limit of a run, in seconds. A run that is not finished by then has failed.
    pub time_limit_s: f64,
    /// Other properties that all runs share, as (name, description) for display.
    pub facts: Vec<(String, String)>,
}
