//! Checks that a polygon is simple.

use crate::geometry::{Point, Rectangle, Segment};
use robust::{Coord, orient2d};

pub(super) const MIN_VERTICES: usize = 3;
pub(super) const MAX_VERTICES: usize = 10_000;
pub(super) const MAX_COORDINATE_M: f64 = 1e9;

/// The reason why a list of vertices is not a polygon. Vertices are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PolygonError {
    /// Too few or too many vertices.
    #[error("a polygon of {least} to {most} vertices; it has {0}", least = MIN_VERTICES, most = MAX_VERTICES)]
    Count(usize),
    /// A coordinate is NaN, infinite or too large.
    #[error("a polygon with coordinates from -{most:e} to {most:e}; vertex {0} is outside", most = MAX_COORDINATE_M)]
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

/// Returns the first error of the closed line through `vertices`.
pub(super) fn check(vertices: &[Point]) -> Result<(), PolygonError> {
    if !(MIN_VERTICES..=MAX_VERTICES).contains(&vertices.len()) {
        return Err(PolygonError::Count(vertices.len()));
    }
    let is_fine = |value: f64| value.abs() <= MAX_COORDINATE_M;
    if let Some(bad) = vertices
        .iter()
        .position(|at| !(is_fine(at.x) && is_fine(at.y)))
    {
        return Err(PolygonError::Coordinate(bad));
    }
    let edges: Vec<Segment> = edges(vertices).collect();
    if let Some(at) = edges.iter().position(|edge| edge.from == edge.to) {
        return Err(PolygonError::Repeated(at));
    }
    let next = |at: usize| (at + 1) % edges.len();
    if let Some(at) = (0..edges.len()).find(|&at| turns_back(edges[at], edges[next(at)])) {
        return Err(PolygonError::Folded(next(at)));
    }
    match crossing(&edges) {
        Some((one, other)) => Err(PolygonError::Crossed(one, other)),
        None => Ok(()),
    }
}

pub(super) fn edges(vertices: &[Point]) -> impl Iterator<Item = Segment> + '_ {
    let next = vertices.iter().cycle().skip(1);
    vertices
        .iter()
        .zip(next)
        .map(|(&from, &to)| Segment { from, to })
}

/// Positive if `point` is to the left of the edge, 0 if it is on its line; exact.
pub(super) fn side(edge: Segment, point: Point) -> f64 {
    let coord = |Point { x, y }| Coord { x, y };
    orient2d(coord(edge.from), coord(edge.to), coord(point))
}

/// Whether `next`, which begins at the end of `edge`, folds back onto it.
fn turns_back(edge: Segment, next: Segment) -> bool {
    side(edge, next.to) == 0.0 && edge.way().dot(next.way()) < 0.0
}

/// Two edges that intersect and are not neighbours.
///
/// Edges are sorted from left to right, and each is compared with those that begin before it ends. For
/// ten thousand edges, that is at most fifty million pairs, most of them settled by their bounding
/// boxes.
fn crossing(edges: &[Segment]) -> Option<(usize, usize)> {
    let bounds: Vec<Rectangle> = edges
        .iter()
        .map(|edge| Rectangle::spanned(edge.from, edge.to))
        .collect();
    let mut order: Vec<usize> = (0..edges.len()).collect();
    order.sort_by(|&one, &other| bounds[one].min().x.total_cmp(&bounds[other].min().x));
    let are_neighbours = |one: usize, other: usize| {
        let apart = one.abs_diff(other);
        apart == 1 || apart == edges.len() - 1
    };
    order.iter().enumerate().find_map(|(place, &one)| {
        order[place + 1..]
            .iter()
            .take_while(|&&other| bounds[other].min().x <= bounds[one].max().x)
            .find(|&&other| {
                bounds[one].overlaps(&bounds[other])
                    && !are_neighbours(one, other)
                    && are_across(edges[one], edges[other])
                    && are_across(edges[other], edges[one])
            })
            .map(|&other| (one.min(other), one.max(other)))
    })
}

/// Whether `other` has a point on the line through `edge`.
fn are_across(edge: Segment, other: Segment) -> bool {
    let (from, to) = (side(edge, other.from), side(edge, other.to));
    from.min(to) <= 0.0 && from.max(to) >= 0.0
}
