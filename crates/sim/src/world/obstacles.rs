//! What is in the way on the ground.

use super::grid::Still;
use base::geometry::{Disc, Point, Polygon, Rectangle};
use base::map::OccupancyMap;
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
        unknown_is_occupied: bool,
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
    /// A map's solid cells.
    Map(OccupancyMap),
}

impl Solid {
    /// Whether it covers a place.
    pub(crate) fn covers(&self, place: Point) -> bool {
        match self {
            Self::Polygon(polygon) => polygon.contains(place),
            Self::Disc(disc) => disc.contains(place),
            Self::Map(map) => map.is_solid(place),
        }
    }
}

impl Still for Solid {
    fn bounds(&self) -> [Point; 2] {
        match self {
            Self::Polygon(polygon) => ends(&polygon.bounds()),
            Self::Disc(disc) => disc.bounds(),
            Self::Map(map) => ends(&map.bounds()),
        }
    }

    fn distance(&self, from: Point) -> f64 {
        match self {
            Self::Polygon(polygon) => polygon.distance_m(from),
            Self::Disc(disc) => disc.distance_m(from),
            // At most: its walls are looked up one by one.
            Self::Map(map) => map.bounds().distance_m(from),
        }
    }
}

fn ends(bounds: &Rectangle) -> [Point; 2] {
    [bounds.min(), bounds.max()]
}
