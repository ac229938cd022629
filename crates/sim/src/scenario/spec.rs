//! A scenario as it is written.

use super::models::{self, ModelSpec};
use crate::bodies::RobotSpec;
use crate::clock::ClockSpec;
use crate::end::EndSpec;
use crate::world::WorldSpec;
use crate::world::items::ItemSpec;
use crate::world::terrain::TerrainSpec;
use base::document::schema::Schema;
use base::document::{Document, Value};
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
    /// Robot models, each under a name of your choice, which `model` selects beside the bundled ones.
    #[serde(default)]
    pub models: BTreeMap<String, ModelSpec>,
    /// Kinds of robots, each under a name of your choice.
    pub robots: BTreeMap<String, RobotSpec>,
    /// When a run is complete and over; without this table, when all targets are found.
    pub end: Option<EndSpec>,
}

/// The other keys at the root are common to all engines.
pub(super) static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::of::<ScenarioSpec>().open());

impl ScenarioSpec {
    /// The keys at the root of a document that this type reads.
    pub const KEYS: [&str; 7] = [
        "clock", "world", "terrain", "items", "models", "robots", "end",
    ];

    /// The schema of [`ScenarioSpec::KEYS`], once every robot kind is completed from its model.
    #[must_use]
    pub fn schema() -> &'static Schema {
        &SCHEMA
    }

    /// A document in which every robot kind and every model is completed from its model.
    #[must_use]
    pub fn filled(document: &Document) -> Document {
        let mut filled = document.clone();
        models::fill(&mut filled);
        filled
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
}
