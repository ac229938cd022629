//! The sensor manager: a referee between the world and the robots.
//!
//! A robot gets what its sensors could recognise, and misses the rest. One file a sensor kind.

pub(crate) mod eye;
pub mod heading;
pub mod items;
mod poisson;
pub mod position;
pub mod range;
pub(crate) mod rays;
pub mod robots;
mod sector;
pub(crate) mod timing;

use heading::HeadingSpec;
use items::ItemsSpec;
use position::PositionSpec;
use range::RangeSpec;
use robots::RobotsSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sensor: what it measures, when, and what that costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SensorSpec {
    /// Looks a second; left out, one a step. A look falls on the first step at or after its time.
    #[schemars(range(min = 0.0001, max = 10_000.0))]
    pub rate_hz: Option<f64>,
    /// Time from a look until the robot has it, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub latency_s: f64,
    /// Probability that a look gives nothing at all.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub dropout: f64,
    /// Power while it is on, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power_w: f64,
    /// What it measures.
    #[serde(flatten)]
    pub measures: Measures,
}

/// What a sensor measures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Measures {
    /// Distances along rays: sonar, infrared, laser.
    Range(RangeSpec),
    /// Items: a camera, a metal detector.
    Items(ItemsSpec),
    /// Other robots.
    Robots(RobotsSpec),
    /// Where the robot is: a satellite receiver.
    Position(PositionSpec),
    /// Where it points: a compass.
    Heading(HeadingSpec),
}
