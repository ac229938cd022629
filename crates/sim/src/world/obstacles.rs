//! Obstacles on the ground.

use super::grid::Still;
use base::geometry::{Disc, Point, Polygon, Rectangle};
use base::hash::Hash;
use base::hashed::Hashed;
use base::map::OccupancyMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An obstacle; obstacles may overlap each other and extend beyond the border.
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
        /// Its centre and radius.
        circle: CircleSpec,
    },
    /// A map as read by ROS `map_server`: a YAML file that names a PGM or PNG image.
    Map {
        /// YAML file of the map, relative to the scenario file.
        map: String,
        /// Position of the lower left corner of the image in the world, in metres. Without it, the `origin` in
        /// the YAML file. The yaw is always that of the file.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at_m: Option<Point>,
        /// Whether unknown cells of the map are occupied.
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

/// An obstacle on the ground, checked.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// A polygon.
    Polygon(Polygon),
    /// A disc.
    Disc(Disc),
    /// The occupied cells of a map.
    Map(OccupancyMap),
}

impl Hashed for Solid {
    fn add_to(&self, hash: &mut Hash) {
        match self {
            Self::Polygon(polygon) => {
                hash.add(0);
                polygon.add_to(hash);
            }
            Self::Disc(disc) => {
                hash.add(1);
                disc.add_to(hash);
            }
            Self::Map(map) => {
                hash.add(2);
                map.add_to(hash);
            }
        }
    }
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
            // Upper limit: its walls are searched linearly.
            Self::Map(map) => map.bounds().distance_m(from),
        }
    }
}

fn ends(bounds: &Rectangle) -> [Point; 2] {
    [bounds.min(), bounds.max()]
}
