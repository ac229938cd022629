//! Solid polygons.

mod simple;

use super::{Point, Rectangle, Segment};
use robust::{Coord, orient2d};

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
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Clockwise.
    vertices: Vec<Point>,
}

/// The reason why a list of vertices is not a polygon. Vertices are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PolygonError {
    /// Too few or too many vertices.
    #[error("a polygon of {least} to {most} vertices; it has {0}", least = Polygon::MIN_VERTICES, most = Polygon::MAX_VERTICES)]
    Count(usize),
    /// A coordinate is NaN, infinite or too large.
    #[error("a polygon with coordinates from -{most:e} to {most:e}; vertex {0} is outside", most = Polygon::MAX_COORDINATE_M)]
    Coordinate(usize),
    /// A vertex equals the next one.
    #[error("a polygon without repeated vertices; vertex {0} equals the next one")]
    Repeated(usize),
    /// An edge folds back onto the previous one at a vertex.
    #[error("a polygon that does not touch itself; it folds back at vertex {0}")]
    Folded(usize),
    /// The edges that begin at these two vertices intersect.
    #[error("a polygon that does not intersect itself; the edges from vertices {0} and {1} do")]
    Crossed(usize, usize),
    /// The area is 0.
    #[error("a polygon with an area above 0")]
    Flat,
}

impl Polygon {
    /// Minimum number of vertices.
    pub const MIN_VERTICES: usize = 3;
    /// Maximum number of vertices.
    pub const MAX_VERTICES: usize = 10_000;
    /// Maximum absolute coordinate, in metres.
    pub const MAX_COORDINATE_M: f64 = 1e9;

    /// The polygon with these vertices, given clockwise or anticlockwise.
    ///
    /// # Errors
    /// The first error found.
    pub fn new(vertices: &[Point]) -> Result<Self, PolygonError> {
        if !(Self::MIN_VERTICES..=Self::MAX_VERTICES).contains(&vertices.len()) {
            return Err(PolygonError::Count(vertices.len()));
        }
        let is_fine = |value: f64| value.abs() <= Self::MAX_COORDINATE_M;
        if let Some(bad) = vertices
            .iter()
            .position(|at| !(is_fine(at.x) && is_fine(at.y)))
        {
            return Err(PolygonError::Coordinate(bad));
        }
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

fn edges(vertices: &[Point]) -> impl Iterator<Item = Segment> + '_ {
    let next = vertices.iter().cycle().skip(1);
    vertices
        .iter()
        .zip(next)
        .map(|(&from, &to)| Segment { from, to })
}

/// Signed area by the shoelace formula about the first vertex; negative if the vertices run clockwise.
fn anticlockwise_area(vertices: &[Point]) -> f64 {
    let first = vertices[0];
    let doubled: f64 = edges(vertices)
        .map(|edge| first.to(edge.from).cross(first.to(edge.to)))
        .sum();
    doubled / 2.0
}

/// Positive if `point` is to the left of the edge, 0 if it is on its line; exact.
fn side(edge: Segment, point: Point) -> f64 {
    let coord = |Point { x, y }| Coord { x, y };
    orient2d(coord(edge.from), coord(edge.to), coord(point))
}

#[cfg(test)]
mod tests;
