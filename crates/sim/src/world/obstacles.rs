//! What is in the way on the ground.

use super::grid::Still;
use base::geometry::{Disc, Point, Polygon};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Something solid; obstacles may overlap each other and reach over the border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ObstacleSpec {
    /// A polygon.
    Polygon {
        /// Its corners in order, in metres; its sides must not cross.
        polygon_m: Vec<Point>,
    },
    /// A disc.
    Circle {
        /// Where it is.
        circle: CircleSpec,
    },
    /// A map as ROS's `map_server` reads it.
    Map {
        /// The map's YAML file, relative to the scenario's file.
        map: String,
        /// Whether cells of which the map knows nothing are solid.
        #[serde(default)]
        unknown_is_solid: bool,
    },
}

/// A disc.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CircleSpec {
    /// Its centre, in metres.
    pub at_m: Point,
    /// Its radius, in metres.
    #[schemars(range(min = 0.001, max = 100_000.0))]
    pub radius_m: f64,
}

/// Something solid on the ground, checked.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// A polygon.
    Polygon(Polygon),
    /// A disc.
    Disc(Disc),
}

impl Solid {
    /// Whether it covers a place.
    pub(crate) fn covers(&self, place: Point) -> bool {
        match self {
            Self::Polygon(polygon) => polygon.contains(place),
            Self::Disc(disc) => disc.contains(place),
        }
    }
}

impl Still for Solid {
    fn bounds(&self) -> [Point; 2] {
        match self {
            Self::Polygon(polygon) => {
                let bounds = polygon.bounds();
                [bounds.min(), bounds.max()]
            }
            Self::Disc(disc) => disc.bounds(),
        }
    }

    fn distance(&self, from: Point) -> f64 {
        match self {
            Self::Polygon(polygon) => polygon.distance_m(from),
            Self::Disc(disc) => disc.distance_m(from),
        }
    }
}
