//! When moving bodies touch, without letting any slip through.
//!
//! Paths are followed chord by chord, and along a chord the moment of contact is the root of a
//! quadratic: so a body of any speed meets what is in its way. Bodies that touch already (rounding
//! may even let them overlap by a hair) are held only if they would come closer.

use super::path::Path;
use crate::world::still::Wall;
use base::geometry::{Disc, Point};

/// How far a point may pass beside a wall's end and still meet it, in metres: none slips through
/// where two walls meet.
const CRACK_M: f64 = 1e-9;

/// The share of `way` after which a point at `from` comes within `radius_m` of the origin.
#[inline]
fn meets_origin(from: Point, way: Point, radius_m: f64) -> Option<f64> {
    let closing = -from.dot(way);
    if closing <= 0.0 {
        return None;
    }
    let power = from.length_squared() - radius_m * radius_m;
    if power <= 0.0 {
        return Some(0.0);
    }
    let root = closing * closing - way.length_squared() * power;
    if root < 0.0 {
        return None;
    }
    let share = power / (closing + root.sqrt());
    (share <= 1.0).then_some(share)
}

/// The share of `way` after which a body at `from` touches a wall.
#[inline]
fn meets_wall(from: Point, way: Point, radius_m: f64, wall: &Wall) -> Option<f64> {
    let offset = wall.start.to(from);
    let closing = way.cross(wall.along);
    let gap = wall.along.cross(offset) - radius_m;
    // From behind, a wall is open: nothing gets there but by being placed there.
    let on_face = (closing > 0.0 && gap > -2.0 * radius_m - 1e-9)
        .then(|| (gap / closing).max(0.0))
        .filter(|share| {
            let foot = offset.dot(wall.along) + share * way.dot(wall.along);
            *share <= 1.0 && (-CRACK_M..=wall.length + CRACK_M).contains(&foot)
        });
    let at_start = meets_origin(offset, way, radius_m);
    let at_end = meets_origin(wall.end().to(from), way, radius_m);
    earliest([on_face, at_start, at_end])
}

fn earliest<const N: usize>(shares: [Option<f64>; N]) -> Option<f64> {
    shares.into_iter().flatten().min_by(f64::total_cmp)
}

/// The share of the step after which a body meets the first of these walls and discs.
#[inline]
pub(crate) fn meets_still<'a>(
    path: &Path,
    radius_m: f64,
    walls: &(impl Iterator<Item = &'a Wall> + Clone),
    discs: &(impl Iterator<Item = &'a Disc> + Clone),
) -> Option<f64> {
    let chords = path.chords();
    (0..chords).find_map(|chord| {
        let share = |chord: u32| f64::from(chord) / f64::from(chords);
        let from = path.at(share(chord));
        let way = from.to(path.at(share(chord + 1)));
        let wall = |wall: &Wall| meets_wall(from, way, radius_m, wall);
        let disc = |disc: &Disc| meets_origin(disc.centre.to(from), way, radius_m + disc.radius_m);
        let meetings = walls.clone().filter_map(wall);
        let first = meetings
            .chain(discs.clone().filter_map(disc))
            .min_by(f64::total_cmp)?;
        Some(share(chord) + first / f64::from(chords))
    })
}

/// The share of the step after which two bodies come within `reach_m` of each other.
pub(crate) fn meets_moving(one: &Path, other: &Path, reach_m: f64) -> Option<f64> {
    let chords = one.chords().max(other.chords());
    let ends = (1..=chords).map(|chord| f64::from(chord) / f64::from(chords));
    let mut before = 0.0;
    let mut from = other.at(0.0).to(one.at(0.0));
    for end in ends {
        // A body that stops on the way does so between two straight pieces.
        for after in pieces(before, end, one.until, other.until) {
            let next = other.at(after).to(one.at(after));
            if let Some(share) = meets_origin(from, from.to(next), reach_m) {
                return Some(before + share * (after - before));
            }
            (before, from) = (after, next);
        }
    }
    None
}

fn pieces(before: f64, end: f64, one: f64, other: f64) -> impl Iterator<Item = f64> {
    let stops = [one.min(other), one.max(other)];
    let within = stops
        .into_iter()
        .filter(move |stop| *stop > before && *stop < end);
    within.chain([end])
}
