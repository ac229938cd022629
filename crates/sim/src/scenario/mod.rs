//! A scenario of the metric engine, gathered from the modules that own its parts.

mod bounds;
mod checks;
mod ready;

pub use ready::Scenario;

use crate::bodies::RobotSpec;
use crate::clock::ClockSpec;
use crate::world::WorldSpec;
use crate::world::items::ItemSpec;
use crate::world::terrain::TerrainSpec;
use base::document::schema::Schema;
use base::document::{Document, Files, Value};
use base::error::InputErrors;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// A scenario as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioSpec {
    /// Time step and time limit.
    pub clock: ClockSpec,
    /// The world.
    pub world: WorldSpec,
    /// Classes of terrain, each under a name of your choice.
    #[serde(default)]
    pub terrain: BTreeMap<String, TerrainSpec>,
    /// Kinds of items, each under a name of your choice.
    #[serde(default)]
    pub items: BTreeMap<String, ItemSpec>,
    /// Kinds of robots, each under a name of your choice.
    pub robots: BTreeMap<String, RobotSpec>,
}

/// A valid scenario.
#[derive(Debug, Clone)]
pub struct Checked {
    /// As it is written; omitted keys have their defaults, or the values of the robot model.
    pub spec: ScenarioSpec,
    /// Converted for runs.
    pub scenario: Scenario,
}

/// The other keys at the root are common to all engines.
static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::of::<ScenarioSpec>().open());

impl ScenarioSpec {
    /// The keys at the root of a document that this type reads.
    pub const KEYS: [&str; 5] = ["clock", "world", "terrain", "items", "robots"];

    /// The schema of [`ScenarioSpec::KEYS`], once every robot kind is completed from its model.
    #[must_use]
    pub fn schema() -> &'static Schema {
        &SCHEMA
    }

    /// Reads [`ScenarioSpec::KEYS`], and nothing else.
    ///
    /// # Errors
    /// Everything that is wrong there: keys and values first and, if these are valid, their meaning
    /// together.
    pub fn read(document: &Document) -> Result<Checked, InputErrors> {
        let document = Self::filled(document);
        let spec = document.typed(&SCHEMA)?;
        checks::checked(spec, &document.place(), &|name| document.open(name))
    }

    /// A document in which every robot kind is completed from its model.
    #[must_use]
    pub fn filled(document: &Document) -> Document {
        let mut filled = document.clone();
        crate::bodies::models::fill(&mut filled);
        filled
    }

    /// The same for a document whose files `open` reads: it returns the bytes of a file by its
    /// name, or the reason why it cannot.
    ///
    /// # Errors
    /// As [`ScenarioSpec::read`].
    pub fn read_with(
        document: &Document,
        open: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Checked, InputErrors> {
        let mut document = document.clone();
        let mut files = Files::new();
        // What has been read may name more files.
        loop {
            let wanted = Self::files(&document);
            if wanted.is_empty() {
                return Self::read(&document);
            }
            files.extend(wanted.into_iter().map(|name| (name.clone(), open(&name))));
            document = document.with_files(files.clone());
        }
    }

    /// The names in the table at `path` of a document, including those of a robot's model, if the
    /// keys of that table are names chosen by the user.
    pub(crate) fn names(document: &Document, path: &[&str]) -> Option<Vec<String>> {
        if !SCHEMA.has_names_at(path) {
            return None;
        }
        match Self::filled(document).get(path).map(|node| &node.value) {
            None => Some(Vec::new()),
            Some(Value::Table(table)) => Some(table.keys().cloned().collect()),
            Some(_) => None,
        }
    }

    /// The files that a document names and that have not been read.
    pub(crate) fn files(document: &Document) -> Vec<String> {
        let spec: Result<Self, InputErrors> = Self::filled(document).typed(&SCHEMA);
        spec.map_or_else(|_| Vec::new(), |spec| checks::files_wanted(&spec, document))
    }
}
