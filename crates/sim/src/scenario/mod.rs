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

/// What a run depends on, as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioSpec {
    /// How time passes.
    pub clock: ClockSpec,
    /// The world.
    pub world: WorldSpec,
    /// Classes of ground, each under a name of your choice.
    #[serde(default)]
    pub terrain: BTreeMap<String, TerrainSpec>,
    /// Kinds of items, each under a name of your choice.
    #[serde(default)]
    pub items: BTreeMap<String, ItemSpec>,
    /// Kinds of robots, each under a name of your choice.
    pub robots: BTreeMap<String, RobotSpec>,
}

/// A scenario in which nothing is wrong.
#[derive(Debug, Clone)]
pub struct Checked {
    /// As it is written; what is left out has its default, or its model's value.
    pub spec: ScenarioSpec,
    /// As runs need it.
    pub scenario: Scenario,
}

/// The other keys at the root are common to all engines.
static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::of::<ScenarioSpec>().open());

impl ScenarioSpec {
    /// The keys at the root of a document that it is read from.
    pub const KEYS: [&str; 5] = ["clock", "world", "terrain", "items", "robots"];

    /// What may stand under [`ScenarioSpec::KEYS`], once every robot kind says what its model says.
    #[must_use]
    pub fn schema() -> &'static Schema {
        &SCHEMA
    }

    /// Reads what stands under [`ScenarioSpec::KEYS`], and nothing else.
    ///
    /// # Errors
    /// Everything that is wrong there: keys and values first, and if these are right, what they mean
    /// together.
    pub fn read(document: &Document) -> Result<Checked, InputErrors> {
        let document = Self::filled(document);
        let spec = document.typed(&SCHEMA)?;
        checks::checked(spec, &document.place(), &|name| document.open(name))
    }

    /// A document in which every robot kind says what the model says that it is like.
    #[must_use]
    pub fn filled(document: &Document) -> Document {
        let mut filled = document.clone();
        crate::bodies::models::fill(&mut filled);
        filled
    }

    /// The same of a document whose files `open` reads: it gives the bytes of one by its name, or
    /// says why it cannot.
    ///
    /// # Errors
    /// As [`ScenarioSpec::read`].
    pub fn read_with(
        document: &Document,
        open: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Checked, InputErrors> {
        let mut document = document.clone();
        let mut files = Files::new();
        // What has been read may name more.
        loop {
            let wanted = Self::files(&document);
            if wanted.is_empty() {
                return Self::read(&document);
            }
            files.extend(wanted.into_iter().map(|name| (name.clone(), open(&name))));
            document = document.with_files(files.clone());
        }
    }

    /// The names in the table at `path` of a document, those of a robot's model among them, if it is
    /// one of things under names of a person's choice.
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
