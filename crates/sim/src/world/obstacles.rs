//! Obstacles on the ground.

use super::grid::Still;
use base::geometry::{Disc, Point, Polygon, Rectangle};
use base::hashed::Hashed;
use base::map::OccupancyMap;
use base::trig::sin_cos;
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
        /// Copies in rows and columns.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        repeat: Option<RepeatSpec>,
    },
    /// A disc.
    Circle {
        /// Its centre and radius.
        circle: CircleSpec,
        /// Copies in rows and columns.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        repeat: Option<RepeatSpec>,
    },
    /// A rectangle.
    Rectangle {
        /// Its centre, size and rotation.
        rectangle: RectangleSpec,
        /// Copies in rows and columns.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        repeat: Option<RepeatSpec>,
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

/// A rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RectangleSpec {
    /// Its centre, in metres.
    pub at_m: Point,
    /// Its width and height before the rotation, in metres.
    pub size_m: [Side; 2],
    /// Rotation about its centre, in degrees, anticlockwise.
    #[serde(default)]
    #[schemars(range(min = -360.0, max = 360.0))]
    pub rotation_deg: f64,
}

/// A side of a rectangle, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Side(#[schemars(range(min = 0.001, max = 100_000.0))] pub f64);

impl RectangleSpec {
    /// Its corners, anticlockwise.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let [width, height] = self.size_m.map(|side| side.0 / 2.0);
        let (sine, cosine) = sin_cos(self.rotation_deg.to_radians());
        let corner = |x: f64, y: f64| Point {
            x: self.at_m.x + (x * cosine - y * sine),
            y: self.at_m.y + (x * sine + y * cosine),
        };
        [
            corner(-width, -height),
            corner(width, -height),
            corner(width, height),
            corner(-width, height),
        ]
    }
}

/// The given shape is the copy in column 1 and row 1. The copies equal separate obstacles, listed row
/// by row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RepeatSpec {
    /// Number of columns, along x.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub columns: u32,
    /// Number of rows, along y.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub rows: u32,
    /// Distance from one column to the next along x, and from one row to the next along y, in
    /// metres.
    pub spacing_m: Point,
}

fn one() -> u32 {
    1
}

/// One of the copies of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RepeatedCopy {
    /// Its column, from 1.
    pub(crate) column: u32,
    /// Its row, from 1.
    pub(crate) row: u32,
    /// Its place relative to the given shape.
    pub(crate) shift: Point,
}

impl RepeatSpec {
    const ONCE: Self = Self {
        columns: 1,
        rows: 1,
        spacing_m: Point { x: 0.0, y: 0.0 },
    };

    /// The copies, row by row; the first is the given shape.
    pub(crate) fn copies(self) -> impl Iterator<Item = RepeatedCopy> {
        let copy = move |row, column| RepeatedCopy {
            column: column + 1,
            row: row + 1,
            shift: Point {
                x: f64::from(column) * self.spacing_m.x,
                y: f64::from(row) * self.spacing_m.y,
            },
        };
        (0..self.rows).flat_map(move |row| (0..self.columns).map(move |column| copy(row, column)))
    }

    /// Number of copies.
    pub(crate) fn count(self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

impl ObstacleSpec {
    /// Its copies; an obstacle without `repeat` is one copy.
    pub(crate) fn repeat(&self) -> RepeatSpec {
        let repeat = match self {
            Self::Polygon { repeat, .. }
            | Self::Circle { repeat, .. }
            | Self::Rectangle { repeat, .. } => *repeat,
            Self::Map { .. } => None,
        };
        repeat.unwrap_or(RepeatSpec::ONCE)
    }

    /// Number of corners of all copies; a disc counts as one.
    pub(crate) fn corners(&self) -> usize {
        let each = match self {
            Self::Polygon { polygon_m, .. } => polygon_m.len(),
            Self::Rectangle { .. } => 4,
            Self::Circle { .. } | Self::Map { .. } => 1,
        };
        each.saturating_mul(self.repeat().count())
    }
}

/// An obstacle on the ground, checked.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub enum Solid {
    /// A polygon.
    Polygon(Polygon),
    /// A disc.
    Disc(Disc),
    /// The occupied cells of a map.
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
            // Upper limit: its walls are searched linearly.
            Self::Map(map) => map.bounds().distance_m(from),
        }
    }
}

fn ends(bounds: &Rectangle) -> [Point; 2] {
    [bounds.min(), bounds.max()]
}
