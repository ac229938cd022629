//! Geometry of the plane, in metres; y points up, and angles are anticlockwise.
//!
//! **Orientation:** seen from `from` to `to`, a [`Segment`] has free space on its left and solid matter
//! on its right. So the vertices of a solid [`Polygon`] run clockwise, and those of a room
//! anticlockwise. The boundary belongs to the solid.

mod disc;
mod polygon;
mod rectangle;
mod segment;
mod torus;

pub use disc::Disc;
pub use polygon::{Polygon, PolygonError};
pub use rectangle::Rectangle;
pub use segment::Segment;
pub use torus::Torus;

use crate::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point or a vector; in files `[x, y]`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Point {
    /// Along the world's width, in metres.
    pub x: f64,
    /// Along the world's height, in metres.
    pub y: f64,
}

impl From<[f64; 2]> for Point {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}

impl From<Point> for [f64; 2] {
    fn from(point: Point) -> Self {
        [point.x, point.y]
    }
}

impl Point {
    /// The vector from `self` to `other`.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self {
            x: other.x - self.x,
            y: other.y - self.y,
        }
    }

    /// The sum of a point and a vector.
    #[must_use]
    pub fn plus(self, way: Self) -> Self {
        Self {
            x: self.x + way.x,
            y: self.y + way.y,
        }
    }

    /// The vector, scaled by `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }

    /// Square of the length of the vector.
    #[must_use]
    pub fn length_squared(self) -> f64 {
        self.x * self.x + self.y * self.y
    }

    /// Length of the vector.
    #[must_use]
    pub fn length(self) -> f64 {
        self.length_squared().sqrt()
    }

    /// Dot product.
    #[must_use]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// Cross product: positive if `other` is to the left of `self`.
    #[must_use]
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }
}
