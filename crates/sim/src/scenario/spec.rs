//! A scenario as it is written.

use super::models::{self, ModelSpec};
use crate::bodies::RobotSpec;
use crate::clock::ClockSpec;
use crate::controllers::ControllerSpec;
use crate::end::EndSpec;
use crate::goals::GoalSpec;
use crate::passage::PassageSpec;
use crate::world::WorldSpec;
use crate::world::items::ItemSpec;
use crate::world::terrain::TerrainSpec;
use base::document::schema::Schema;
use base::document::{Document, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

/// A scenario as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioSpec {
    /// Time step, time limit, and the clocks of robots and controllers.
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
    /// Kinds of controllers, each under a name of your choice.
    #[serde(default)]
    pub controllers: BTreeMap<String, ControllerSpec>,
    /// Kinds of goals, each under a name of your choice.
    #[serde(default)]
    pub goals: BTreeMap<String, GoalSpec>,
    /// Vehicles that are to pass the lane that controllers clear.
    pub passage: Option<PassageSpec>,
    /// When a run is complete and over; without this table, when all targets are found and all goals are served.
    pub end: Option<EndSpec>,
}

/// The other keys at the root are common to all engines.
pub(super) static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema::of::<ScenarioSpec>().open());

impl ScenarioSpec {
    /// The keys at the root of a document that this type reads.
    pub const KEYS: [&str; 10] = [
        "clock",
        "world",
        "terrain",
        "items",
        "models",
        "robots",
        "controllers",
        "goals",
        "passage",
        "end",
    ];

    /// The schema of [`ScenarioSpec::KEYS`], once every robot kind is completed from its model.
    #[must_use]
    pub fn schema() -> &'static Schema {
        &SCHEMA
    }

    /// The names of all capabilities of robots, sorted: their numbers are their places, from 1.
    pub(crate) fn capabilities(&self) -> Vec<String> {
        let robots = self.robots.values();
        let names: BTreeSet<&String> = robots.flat_map(|robot| &robot.capabilities).collect();
        names.into_iter().cloned().collect()
    }

    /// Whether controllers are to clear a lane.
    pub(crate) fn has_clearance(&self) -> bool {
        let mut controllers = self.controllers.values();
        controllers.any(|kind| kind.clearance.is_some())
    }

    /// Whether robots or controllers fail at random times.
    pub(super) fn has_failures(&self) -> bool {
        let robots = self.robots.values();
        let robots = robots.map(|kind| kind.mean_time_between_failures_s);
        let controllers = self.controllers.values();
        let controllers = controllers.map(|kind| kind.mean_time_between_failures_s);
        robots.chain(controllers).any(|mean_s| mean_s.is_some())
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
