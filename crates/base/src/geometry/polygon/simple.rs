//! Checks that a polygon is simple.

use super::{Point, PolygonError, Rectangle, Segment, edges, side};

/// Returns the first error of the closed line through `vertices`.
pub(super) fn check(vertices: &[Point]) -> Result<(), PolygonError> {
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
