//! Robots of all kinds, put where none overlaps another.

use super::crowd::Crowd;
use super::{Draws, NoPlace, Placement};
use crate::geometry::Point;
use crate::random::Entity;

/// The robots of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Group<'p> {
    /// Number of the kind, for [`NoPlaceFor`].
    pub kind: u8,
    /// That of [`Entity::kind`].
    pub key: u32,
    /// How many robots.
    pub count: u32,
    /// Radius of a robot.
    pub radius_m: f64,
    /// Only robots in the same layer keep out of each other's way.
    pub layer: u8,
    /// Where they are put.
    pub placement: &'p Placement,
}

/// A robot that has no place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("robot {index} of kind {kind}: {why}")]
pub struct NoPlaceFor {
    /// Number of its kind.
    pub kind: u8,
    /// Its index within the kind.
    pub index: u32,
    /// Why.
    pub why: NoPlace,
}

/// Where the robots of a team are put, a list a group, so that none overlaps another in its layer.
///
/// **Who gives way.** Robots are put down in order: first the groups with given places, then the
/// others, each in the order of `groups` and of the index. Each robot has a sequence of places of
/// its own, as in [`Placement::place`], and takes the first that `is_free` and that no robot before
/// it overlaps. So with one robot more at the end of its group,
///
/// * no other robot of its group, and none of a group before it, is anywhere else;
/// * a robot of a group after it is elsewhere only if its place is now overlapped, by the new robot
///   or by one that is elsewhere because of it, or if such a one has left a place that it tried first.
///
/// Robots that only touch do not overlap. The time goes with the number of robots, not its square.
///
/// # Errors
/// The first robot for which no place is found.
pub fn team(
    draws: &Draws,
    groups: &[Group],
    is_free: impl Fn(&Group, Point) -> bool,
) -> Result<Vec<Vec<Point>>, NoPlaceFor> {
    let is_given = |group: &Group| matches!(group.placement, Placement::Fixed { .. });
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|&at| !is_given(&groups[at]));
    let mut places = vec![Vec::new(); groups.len()];
    let discs = groups.iter().map(|group| (group.layer, group.radius_m));
    let mut crowd = Crowd::new(discs, draws.torus);
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

/// The first place of one robot that `is_open`. Clusters are where it `is_free`, whoever stands there.
fn place(
    draws: &Draws,
    group: &Group,
    index: u32,
    is_free: impl Fn(Point) -> bool,
    is_open: impl Fn(Point) -> bool,
) -> Result<Point, NoPlaceFor> {
    let Group { kind, key, .. } = *group;
    let entity = Entity { kind: key, index };
    group
        .placement
        .candidates(draws, entity, is_free)
        .and_then(|candidates| candidates.first(is_open))
        .map_err(|why| NoPlaceFor { kind, index, why })
}
