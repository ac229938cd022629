//! The robots' bodies: how they move, what they run into, and what drains them.

pub mod battery;
pub mod collision;
pub(crate) mod contact;
pub mod drive;
pub(crate) mod kind;
pub mod models;
pub(crate) mod path;

use crate::radio::RadioSpec;
use crate::sensors::SensorSpec;
use base::placement::Placement;
use battery::BatterySpec;
use brain::BrainSpec;
use collision::CollisionSpec;
use drive::DriveSpec;
use models::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A kind of robot, and how many of it there are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotSpec {
    /// A shipped robot whose values stand for all that is left out here.
    pub model: Option<Model>,
    /// Robots of this kind in the team.
    #[schemars(range(max = 1_000_000))]
    pub count: u32,
    /// What it moves through.
    #[serde(default)]
    pub layer: Layer,
    /// Of the disc that it covers, in metres.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub radius_m: f64,
    /// What one costs, in any unit; the merit's term `price` sums it over the team.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub price: f64,
    /// Mass without payload, in kg.
    #[serde(default = "one")]
    #[schemars(range(min = 0.001, max = 1e6))]
    pub mass_kg: f64,
    /// Mass that it carries, in kg; each metre takes energy in proportion to the whole mass.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub payload_kg: f64,
    /// Where robots start.
    #[serde(default)]
    pub start: Placement,
    /// How it moves.
    pub drive: DriveSpec,
    /// What a collision costs.
    #[serde(default)]
    pub collision: CollisionSpec,
    /// Its battery; left out, energy is not counted.
    pub battery: Option<BatterySpec>,
    /// Its sensors, each under a name of your choice.
    #[serde(default)]
    pub sensors: BTreeMap<String, SensorSpec>,
    /// Its radio; left out, it neither sends nor hears.
    pub radio: Option<RadioSpec>,
    /// Its agent.
    #[serde(default)]
    pub brain: BrainSpec,
}

/// What a body moves through.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// On the ground: obstacles and other ground robots are in its way.
    #[default]
    Ground,
    /// In the air: only other air robots and the world's border are in its way.
    Air,
}

fn one() -> f64 {
    1.0
}
