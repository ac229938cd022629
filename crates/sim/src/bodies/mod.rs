//! The bodies of robots: how they move, what they collide with, and their energy.

pub mod battery;
pub(crate) mod body_state;
pub mod collision;
pub(crate) mod contact;
pub mod drive;
pub mod external;
pub(crate) mod kind;
pub mod models;
pub(crate) mod path;
pub(crate) mod region;
pub(crate) mod source;
pub mod tools;

use crate::radio::RadioSpec;
use crate::sensors::SensorSpec;
use base::placement::Placement;
use battery::BatterySpec;
use brain::BrainSpec;
use collision::CollisionSpec;
use drive::DriveSpec;
use models::ModelName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use tools::ToolsSpec;

/// A kind of robot, and the number of these robots.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotSpec {
    /// A robot model: a bundled one, or one of `[models]`. Its values replace all keys that are not set here.
    pub model: Option<ModelName>,
    /// Number of robots of this kind in the team.
    #[schemars(range(max = 1_000_000))]
    pub count: u32,
    /// The layer in which the robot moves.
    #[serde(default)]
    pub layer: Layer,
    /// Radius of the robot's disc-shaped footprint, in metres.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub radius_m: f64,
    /// Price of one robot, in any currency. The merit term `price` sums it over the team.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub price: f64,
    /// Mass without payload, in kg.
    #[serde(default = "one")]
    #[schemars(range(min = 0.001, max = 1e6))]
    pub mass_kg: f64,
    /// Mass of the payload, in kg. The energy per metre is proportional to the total mass.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub payload_kg: f64,
    /// Where the robots start.
    #[serde(default)]
    pub start: Placement,
    /// How the robot moves.
    pub drive: DriveSpec,
    /// Consequences of a collision.
    #[serde(default)]
    pub collision: CollisionSpec,
    /// The battery. Without it, energy is not counted.
    pub battery: Option<BatterySpec>,
    /// What it can do besides moving, each under a name of your choice: goals require capabilities.
    #[serde(default)]
    #[schemars(length(max = 255))]
    pub capabilities: Vec<String>,
    /// Mean time until a robot breaks down, in seconds. Without it, robots only break in collisions.
    #[schemars(range(min = 0.001, max = 1e12))]
    pub mean_time_between_failures_s: Option<f64>,
    /// Indices of robots that have failed: from the start, or from when this changes in a run. They stay
    /// broken when their index is removed. Others than those of the team have no effect.
    #[serde(default)]
    pub failed: Vec<u32>,
    /// Indices of robots that are out of service: from the start, or from when this changes in a run. They
    /// return the goals that controllers awarded to them, and bid for none until their index is removed.
    /// Others than those of the team have no effect.
    #[serde(default)]
    pub out_of_service: Vec<u32>,
    /// The sensors, each under a name of your choice.
    #[serde(default)]
    pub sensors: BTreeMap<String, SensorSpec>,
    /// Tools with which it acts on items.
    #[serde(default)]
    pub tools: ToolsSpec,
    /// The radio. Without it, the robot neither sends nor receives.
    pub radio: Option<RadioSpec>,
    /// What the robot does: its behaviours, and how they are combined.
    #[serde(default)]
    pub brain: BrainSpec,
}

/// The layer in which a body moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// On the ground: obstacles and other ground robots are in its way.
    #[default]
    Ground,
    /// In the air: only other air robots and the border of the world are in its way.
    Air,
}

fn one() -> f64 {
    1.0
}
