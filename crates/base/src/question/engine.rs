//! What a simulator tells of itself, so that scenarios can name it and studies ask about it.

use super::merit::{Measure, NamedMerit};
use crate::document::Document;
use crate::error::InputErrors;
use crate::runner::Runner;

/// A simulator, as scenarios see it.
///
/// A scenario has keys of two owners: `engine`, `summary`, `merit`, `study` and `published` are the
/// question's, and read in this module; all others are the engine's.
pub trait Engine: Sync {
    /// How scenarios name it.
    fn name(&self) -> &'static str;

    /// Its own keys at the root of a scenario.
    fn keys(&self) -> &'static [&'static str];

    /// Reads what stands under its keys; it does not look at others.
    ///
    /// # Errors
    /// Everything that is wrong there.
    fn read(&self, document: &Document) -> Result<Configuration, InputErrors>;

    /// The files that a document names and that have not been read: see [`Document::open`]. When
    /// they have, it may name more. It is asked of documents with errors too.
    fn files(&self, _document: &Document) -> Vec<String> {
        Vec::new()
    }

    /// What a figure of merit can weigh, in the order of its sum; it is asked of documents with
    /// errors too.
    fn measures(&self, document: &Document) -> Vec<Measure>;

    /// The figures of merit that have names.
    fn merits(&self) -> &'static [NamedMerit];

    /// The paths that a study can vary, in the order in which it varies them. `None`: any path under
    /// its keys at which [`Engine::read`] takes a number, `true`, `false` or a name.
    fn factors(&self) -> Option<&'static [&'static str]>;

    /// The names in the table at `path`, if it is one of things under names of a person's choice,
    /// whether it is there or not; it is asked of documents with errors too.
    fn names(&self, document: &Document, path: &[&str]) -> Option<Vec<String>>;

    /// The largest team.
    fn most_robots(&self) -> u32;
}

/// What an engine has read of a scenario.
pub struct Configuration {
    /// Ready to be run.
    pub runner: Box<dyn Runner>,
    /// Robots of each kind.
    pub robots: Vec<(String, u32)>,
    /// A run that takes longer has failed, and counts as this long.
    pub cap_s: f64,
    /// What else is the same in every run, for people: names, and texts of them.
    pub facts: Vec<(String, String)>,
}
