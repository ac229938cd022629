//! Axis-aligned rectangles.

use super::{Point, Segment};
use crate::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An axis-aligned rectangle, including its boundary. In files, two opposite corners,
/// `[[x, y], [x, y]]`, in any order.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(from = "[Point; 2]", into = "[Point; 2]")]
pub struct Rectangle {
    min: Point,
    max: Point,
}

impl From<[Point; 2]> for Rectangle {
    fn from([one, other]: [Point; 2]) -> Self {
        Self::spanned(one, other)
    }
}

impl From<Rectangle> for [Point; 2] {
    fn from(rectangle: Rectangle) -> Self {
        [rectangle.min, rectangle.max]
    }
}

impl Rectangle {
    /// The rectangle with these two opposite corners.
    #[must_use]
    pub fn spanned(one: Point, other: Point) -> Self {
        Self {
            min: Point {
                x: one.x.min(other.x),
                y: one.y.min(other.y),
            },
            max: Point {
                x: one.x.max(other.x),
                y: one.y.max(other.y),
            },
        }
    }

    /// The bounding box of `points`; `None` without points.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Point>) -> Option<Self> {
        points
            .into_iter()
            .map(|point| Self::spanned(point, point))
            .reduce(|all, one| all.joined(&one))
    }

    /// The corner with the smallest coordinates.
    #[must_use]
    pub fn min(&self) -> Point {
        self.min
    }

    /// The corner with the largest coordinates.
    #[must_use]
    pub fn max(&self) -> Point {
        self.max
    }

    /// The bounding box of both.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            min: Self::spanned(self.min, other.min).min,
            max: Self::spanned(self.max, other.max).max,
        }
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> Point {
        self.min.to(self.max)
    }

    /// Its area, in square metres.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.size().x * self.size().y
    }

    /// Whether it contains `point`.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        (self.min.x..=self.max.x).contains(&point.x) && (self.min.y..=self.max.y).contains(&point.y)
    }

    /// Whether the two overlap or touch.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }

    /// Distance from `point` to the rectangle; 0 inside.
    #[must_use]
    pub fn distance_m(&self, point: Point) -> f64 {
        let nearest = Point {
            x: point.x.max(self.min.x).min(self.max.x),
            y: point.y.max(self.min.y).min(self.max.y),
        };
        nearest.to(point).length()
    }

    /// Its four walls, as those of a room with a free inside.
    #[must_use]
    pub fn room(&self) -> [Segment; 4] {
        let Self { min, max } = *self;
        let corners = [
            min,
            Point { x: max.x, y: min.y },
            max,
            Point { x: min.x, y: max.y },
        ];
        std::array::from_fn(|at| Segment {
            from: corners[at],
            to: corners[(at + 1) % 4],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_may_be_given_in_any_order() {
        let rectangle: Rectangle = serde_json::from_str("[[3, 1], [0, 5]]").unwrap();
        assert_eq!(rectangle.min(), [0.0, 1.0].into());
        assert_eq!(rectangle.max(), [3.0, 5.0].into());
        assert!((rectangle.area_m2() - 12.0).abs() < 1e-15);
    }

    #[test]
    fn a_room_is_free_inside() {
        let room = Rectangle::spanned([0.0, 0.0].into(), [4.0, 3.0].into());
        let inside = Point { x: 1.0, y: 1.0 };
        for wall in room.room() {
            assert!(wall.way().cross(wall.from.to(inside)) > 0.0, "{wall:?}");
        }
        assert!((room.distance_m([7.0, 7.0].into()) - 5.0).abs() < 1e-15);
        assert!(room.distance_m(inside).abs() < 1e-15);
    }
}
