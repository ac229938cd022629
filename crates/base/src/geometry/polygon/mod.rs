//! Solid polygons.

mod simple;

pub use simple::PolygonError;

use super::{Point, Rectangle, Segment};
use crate::hashed::Hashed;
use simple::{MAX_COORDINATE_M, MAX_VERTICES, MIN_VERTICES, edges, side};

/// A solid simple polygon, including its boundary.
///
/// Containment and simplicity are decided with exact arithmetic (Shewchuk, *Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates*, 1997).
///
/// ```
/// use base::geometry::{Point, Polygon};
/// let wall = Polygon::new(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(Point::from))?;
/// assert!(wall.contains(Point { x: 2.0, y: 0.5 }));
/// # Ok::<(), base::geometry::PolygonError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Hashed)]
pub struct Polygon {
    /// Clockwise.
    vertices: Vec<Point>,
}

impl Polygon {
    /// Minimum number of vertices.
    pub const MIN_VERTICES: usize = MIN_VERTICES;
    /// Maximum number of vertices.
    pub const MAX_VERTICES: usize = MAX_VERTICES;
    /// Maximum absolute coordinate, in metres.
    pub const MAX_COORDINATE_M: f64 = MAX_COORDINATE_M;

    /// The polygon with these vertices, given clockwise or anticlockwise.
    ///
    /// # Errors
    /// The first error found.
    pub fn new(vertices: &[Point]) -> Result<Self, PolygonError> {
        simple::check(vertices)?;
        let mut vertices = vertices.to_vec();
        let area_m2 = anticlockwise_area(&vertices);
        if area_m2 == 0.0 {
            return Err(PolygonError::Flat);
        }
        if area_m2 > 0.0 {
            vertices.reverse();
        }
        Ok(Self { vertices })
    }

    /// Its edges, with the free outside on their left.
    pub fn edges(&self) -> impl Iterator<Item = Segment> + '_ {
        edges(&self.vertices)
    }

    /// Its bounding box.
    #[must_use]
    pub fn bounds(&self) -> Rectangle {
        let first = self.vertices[0];
        Rectangle::around(self.vertices.iter().copied())
            .unwrap_or_else(|| Rectangle::spanned(first, first))
    }

    /// Whether it contains `point`, by exact arithmetic. Linear in the number of edges.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        // The ray from the point to the right crosses an odd number of edges if the point is inside.
        let mut is_inside = false;
        for edge in self.edges() {
            let side = side(edge, point);
            if side == 0.0 && Rectangle::spanned(edge.from, edge.to).contains(point) {
                return true;
            }
            let goes_up = edge.to.y > point.y;
            if goes_up != (edge.from.y > point.y) {
                is_inside ^= (side > 0.0) == goes_up;
            }
        }
        is_inside
    }

    /// Distance from `point` to the polygon; 0 inside. Linear in the number of edges.
    #[must_use]
    pub fn distance_m(&self, point: Point) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let distances = self.edges().map(|edge| edge.distance_m(point));
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// Signed area by the shoelace formula about the first vertex; negative if the vertices run clockwise.
fn anticlockwise_area(vertices: &[Point]) -> f64 {
    let first = vertices[0];
    let doubled: f64 = edges(vertices)
        .map(|edge| first.to(edge.from).cross(first.to(edge.to)))
        .sum();
    doubled / 2.0
}

#[cfg(test)]
mod tests;
