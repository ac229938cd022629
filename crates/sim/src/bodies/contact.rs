//! Continuous collision detection between moving bodies: none passes through another.
//!
//! Paths are followed chord by chord, and along a chord the time of contact is the root of a
//! quadratic, so a body of any speed meets what is in its way. Bodies that already touch (rounding
//! may even make them overlap by a hair) are stopped only if they would approach each other.

use super::path::Path;
use crate::world::static_geometry::Wall;
use base::geometry::{Disc, Point};

/// A point that passes the end of a wall at up to this distance still meets it, in metres: nothing
/// slips through where two walls meet.
const CRACK_M: f64 = 1e-9;

/// Squared sine of the largest angle to a tangent that counts as rounding: a body that moves along
/// something round can leave it.
const ALONG: f64 = 1e-24;

/// Whether `way` brings a point at `from` closer to the origin.
#[inline]
fn is_closing(from: Point, way: Point) -> bool {
    let closing = -from.dot(way);
    closing > 0.0 && closing * closing > ALONG * from.length_squared() * way.length_squared()
}

/// The fraction of `way` after which a point at `from` comes within `radius_m` of the origin.
#[inline]
fn meets_origin(from: Point, way: Point, radius_m: f64) -> Option<f64> {
    if !is_closing(from, way) {
        return None;
    }
    let closing = -from.dot(way);
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

/// The fraction of `way` after which a body at `from` touches a wall.
#[inline]
fn meets_wall(from: Point, way: Point, radius_m: f64, wall: &Wall) -> Option<f64> {
    let offset = wall.start.to(from);
    let closing = way.cross(wall.along);
    let gap = wall.along.cross(offset) - radius_m;
    // A wall is open from behind: a body is there only if it was placed there.
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

/// The fraction of the step after which a body meets the first of these walls and discs.
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

/// How two bodies meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Encounter {
    /// Fraction of the step after which they touch.
    pub(crate) share: f64,
    /// Which of them approaches the other then.
    pub(crate) comes: [bool; 2],
}

/// How two bodies come within `reach_m` of each other after a fraction `since` of the step.
pub(crate) fn meets_moving(
    [one, other]: [&Path; 2],
    reach_m: f64,
    since: f64,
) -> Option<Encounter> {
    let chords = one.chords().max(other.chords());
    let ends = (1..=chords).map(|chord| f64::from(chord) / f64::from(chords));
    let mut before = since;
    let mut from = other.at(since).to(one.at(since));
    for end in ends.filter(|end| *end > since) {
        // A body that stops during the step stops between two straight pieces.
        for after in pieces(before, end, one.until, other.until) {
            let next = other.at(after).to(one.at(after));
            let way = from.to(next);
            if let Some(share) = meets_origin(from, way, reach_m) {
                let ways = [one, other].map(|path| path.at(before).to(path.at(after)));
                return Some(Encounter {
                    share: before + share * (after - before),
                    comes: comes(from.plus(way.times(share)), ways),
                });
            }
            (before, from) = (after, next);
        }
    }
    None
}

/// Which of two bodies that meet approaches the other, given the vector from the second to the
/// first.
fn comes(apart: Point, [one, other]: [Point; 2]) -> [bool; 2] {
    let comes = [is_closing(apart, one), is_closing(apart.times(-1.0), other)];
    // They do meet: where by rounding neither approaches, both do.
    if comes == [false; 2] {
        [true; 2]
    } else {
        comes
    }
}

fn pieces(before: f64, end: f64, one: f64, other: f64) -> impl Iterator<Item = f64> {
    let stops = [one.min(other), one.max(other)];
    let within = stops
        .into_iter()
        .filter(move |stop| *stop > before && *stop < end);
    within.chain([end])
}
