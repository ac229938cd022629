//! The seam between simulators and studies.
//!
//! An [`Engine`] describes a simulator: the scenario keys that it reads, what a study can vary, and
//! what a figure of merit can weigh. It reads a scenario into a [`Configuration`], whose [`Runner`]
//! computes blocks of runs.

mod runner;

pub use runner::{BlockOptions, Column, ColumnKind, Runner};

use crate::document::{Document, Value};
use crate::error::InputErrors;
use crate::warning::Warning;
use std::borrow::Cow;

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

    /// The files that a document refers to and that have not been read yet: see [`Document::open`].
    /// Once they are read, there may be more. Called on documents with errors, too.
    fn files(&self, _document: &Document) -> Vec<String> {
        Vec::new()
    }

    /// The terms that a figure of merit can weigh, in the order of summation. Called on documents
    /// with errors, too.
    fn merit_terms(&self, document: &Document) -> Vec<MeritTerm>;

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

/// A term that a figure of merit can weigh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeritTerm {
    /// Its name in scenarios, such as `time`.
    pub name: Cow<'static, str>,
    /// The outcome column that it reads.
    pub column: Cow<'static, str>,
    /// For a column without a natural bound, whose terms need a `max`: the `max` that error messages
    /// propose.
    pub usual_max: Option<f64>,
}

impl MeritTerm {
    /// A term on `column`, which has natural bounds.
    #[must_use]
    pub fn new(name: impl Into<Cow<'static, str>>, column: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            column: column.into(),
            usual_max: None,
        }
    }
}

/// A predefined figure of merit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMerit {
    /// Its name in scenarios.
    pub name: &'static str,
    /// Terms and their weights.
    pub weights: &'static [(&'static str, f64)],
}

impl NamedMerit {
    /// Equation 5.2 of Williams 2003: -(0.3 T/10 + 0.2 n + 0.5 failures in ten).
    pub const EQUATION_5_2: Self = Self {
        name: "equation-5.2",
        weights: &[("time", -0.03), ("robots", -0.2), ("failed", -5.0)],
    };
}
