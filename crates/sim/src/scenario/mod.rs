//! A scenario of the metric engine, gathered from the modules that own its parts.

mod ready;

pub use ready::Scenario;

use crate::body::RobotSpec;
use crate::clock::ClockSpec;
use crate::world::WorldSpec;
use crate::world::items::ItemSpec;
use crate::world::terrain::TerrainSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

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
