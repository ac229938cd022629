//! Everything static: borders, obstacles, terrain, and items.

pub(crate) mod buckets;
pub(crate) mod grid;
pub mod item_number;
pub mod items;
pub mod obstacles;
pub mod origin;
pub(crate) mod static_geometry;
pub mod terrain;

use obstacles::ObstacleSpec;
use origin::OriginSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rectangle and the obstacles in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorldSpec {
    /// Width and height, in metres; x runs from 0 to the width, y from 0 to the height.
    pub size_m: [Length; 2],
    /// Whether the world is periodic: a robot that leaves on one side enters on the opposite one,
    /// and all distances are to the nearest image. Otherwise it has a wall around it.
    #[serde(default)]
    pub periodic: bool,
    /// Obstacles on the ground.
    #[serde(default)]
    pub obstacles: Vec<ObstacleSpec>,
    /// Place of the world on the earth.
    pub origin: Option<OriginSpec>,
}

/// A length of a world, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Length(#[schemars(range(min = 0.1, max = 100_000.0))] pub f64);
