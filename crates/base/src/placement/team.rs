//! Positions of the robots of a team, without overlaps.

use super::disc_index::DiscIndex;
use super::{Placement, PlacementContext, PlacementError};
use crate::geometry::Point;
use crate::random::Entity;

/// The robots of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Group<'p> {
    /// Index of the kind, for [`TeamPlacementError`].
    pub kind: u8,
    /// The key of the kind in [`Entity::kind`].
    pub key: u32,
    /// Number of robots.
    pub count: u32,
    /// Radius of a robot.
    pub radius_m: f64,
    /// Layer: only robots of the same layer may not overlap.
    pub layer: u8,
    /// Their placement.
    pub placement: &'p Placement,
}

/// The error that a robot has no position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("robot {index} of kind {kind}: {why}")]
pub struct TeamPlacementError {
    /// Index of its kind.
    pub kind: u8,
    /// Its index within the kind.
    pub index: u32,
    /// The reason.
    pub why: PlacementError,
}

/// The positions of the robots of a team, one list per group, without overlaps within a layer.
///
/// **Order of placement.** Groups with fixed positions come first, then the others, each in the order
/// of `groups` and of the index. Each robot has its own sequence of candidates, as in
/// [`Placement::place`], and takes the first that `is_free` and that overlaps no earlier robot. So if
/// one robot is added at the end of its group,
///
/// * no other robot of its group, and none of an earlier group, moves;
/// * a robot of a later group moves only if the new robot, or one that has moved because of it, now
///   overlaps its position or has freed an earlier candidate of it.
///
/// Touching is no overlap. The time is proportional to the number of robots.
///
/// # Errors
/// The first robot for which no position is found.
pub fn team(
    draws: &PlacementContext,
    groups: &[Group],
    is_free: impl Fn(&Group, Point) -> bool,
) -> Result<Vec<Vec<Point>>, TeamPlacementError> {
    let is_given = |group: &Group| matches!(group.placement, Placement::Fixed { .. });
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|&at| !is_given(&groups[at]));
    let mut places = vec![Vec::new(); groups.len()];
    let discs = groups.iter().map(|group| (group.layer, group.radius_m));
    let mut crowd = DiscIndex::new(discs, draws.torus);
    for at in order {
        let group = &groups[at];
        for index in 0..group.count {
            let is_open = |place| is_free(group, place) && !crowd.is_taken(at, place);
            let place = place(draws, group, index, |place| is_free(group, place), is_open)?;
            crowd.add(at, place);
            places[at].push(place);
        }
    }
    Ok(places)
}

/// The first candidate of a robot that `is_open`. The centre of its cluster only needs to be `is_free`:
/// other robots do not matter.
fn place(
    draws: &PlacementContext,
    group: &Group,
    index: u32,
    is_free: impl Fn(Point) -> bool,
    is_open: impl Fn(Point) -> bool,
) -> Result<Point, TeamPlacementError> {
    let Group { kind, key, .. } = *group;
    let entity = Entity { kind: key, index };
    group
        .placement
        .candidates(draws, entity, is_free)
        .and_then(|candidates| candidates.first(is_open))
        .map_err(|why| TeamPlacementError { kind, index, why })
}
