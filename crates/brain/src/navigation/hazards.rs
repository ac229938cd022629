//! Discs that the paths of a robot keep clear of, around items that may destroy it.
//!
//! An item has a disc with the radius
//!
//! ```text
//! distance of the danger + radius of the robot + margin
//! margin = 0.4 m for control + 2 standard deviations of its position, at most MAX_MARGIN_M
//! ```
//!
//! The distance is the largest at which the item is a danger with a probability of at least [`MIN_PROBABILITY`]: that
//! there is an item, of one of the kinds that are a danger at that distance.
//!
//! The paths of a robot to an item on which it is to work keep less clear of it if its sensor or tool does not reach it
//! from outside the disc: up to the distance with the margin 0.1 m for control + 3 standard deviations.
//!
//! A robot inside a disc leaves it: it does not come nearer to the item, but may move away from it.

use super::reachable::Reachable;
use crate::io::body::Body;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::field::Field;
use crate::perception::beliefs::items::track::{Track, probability};
use crate::perception::beliefs::pose::Pose;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::{Disc, Point, Segment};
use core::f64::consts::TAU;

/// Items of lower probability have no disc: a detour costs little beside a robot, but false alarms must not close
/// the field.
const MIN_PROBABILITY: f64 = 0.1;

/// Standard deviations of the position of an item that its disc covers.
const DEVIATIONS: f64 = 2.0;

/// Margin for turns and brakes: bodies do not follow paths exactly, in metres.
const CONTROL_M: f64 = 0.4;

/// The same near an item on which the robot is to work: it stops there.
const WORK_DEVIATIONS: f64 = 3.0;
const WORK_CONTROL_M: f64 = 0.1;

/// Robots use at most this much less than the range of a sensor or tool, in metres.
pub(crate) const WORK_REACH_M: f64 = 0.1;

/// How much farther than the edge of the disc of such an item a robot may be, in metres.
const WORK_ROOM_M: f64 = 0.2;

/// The highest margin for the error of a position and for control, in metres: items reported with large errors must not close the
/// field.
const MAX_MARGIN_M: f64 = 2.0;

/// Rounding tolerance of distances, in metres.
const ROUNDING_M: f64 = 1e-9;

/// Number of directions in which an end of a path outside all discs is tried.
const ENDS: u8 = 24;

/// A path ends at most this far outside a disc, in metres, and at least this far inside the tolerance of its goal.
const END_MARGIN_M: f64 = 0.25;
const MIN_END_MARGIN_M: f64 = 0.02;

/// The discs around the items that a robot believes in.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hazards {
    discs: Vec<Disc>,
    /// The smallest radius that each disc can have for work on its item.
    min_radii_m: Vec<f64>,
    /// Kept between steps to reuse its allocation.
    shares: Vec<f64>,
}

impl Hazards {
    /// Takes the discs from the beliefs of a robot.
    pub(crate) fn update(&mut self, beliefs: &Beliefs, body: &Body) {
        self.discs.clear();
        self.min_radii_m.clear();
        if body.hazards_m.is_empty() {
            return;
        }
        for track in &beliefs.items.tracks {
            let exists = probability(track.log_odds());
            // Most tracks of false alarms end here.
            if exists < MIN_PROBABILITY {
                continue;
            }
            self.write_shares(track, beliefs, body.hazards_m.len());
            let deviation_m = libm::sqrt(track.variance_m2.max(0.0));
            let margin_m = CONTROL_M + DEVIATIONS * deviation_m;
            if let Some(danger_m) = danger_m(&body.hazards_m, &self.shares, exists) {
                let work_m = WORK_CONTROL_M + WORK_DEVIATIONS * deviation_m;
                self.min_radii_m.push(danger_m + body.radius_m + work_m);
                self.discs.push(Disc {
                    centre: track.at,
                    radius_m: danger_m + body.radius_m + margin_m.min(MAX_MARGIN_M),
                });
            }
        }
    }

    /// Lets a path end within a distance of a place of work, as far as that is safe: the discs around it are as small as
    /// necessary.
    pub(crate) fn admit(&mut self, place: Point, within_m: f64) {
        for (disc, min_radius_m) in self.discs.iter_mut().zip(&self.min_radii_m) {
            if disc.centre.to(place).length() < disc.radius_m {
                let needed_m = (within_m - WORK_ROOM_M).max(*min_radius_m);
                disc.radius_m = disc.radius_m.min(needed_m);
            }
        }
    }

    /// Writes the probability of each kind, given that there is an item.
    fn write_shares(&mut self, track: &Track, beliefs: &Beliefs, kinds: usize) {
        if let Some(model) = &beliefs.items.kinds {
            track.write_kind_shares(model, beliefs.id, &mut self.shares);
        } else {
            let is_its = |kind: usize| kind == usize::from(track.kind);
            let shares = (0..kinds).map(|kind| f64::from(u8::from(is_its(kind))));
            self.shares.clear();
            self.shares.extend(shares);
        }
    }

    /// Whether the discs are the same.
    pub(crate) fn are_same(&self, other: &Self) -> bool {
        self.discs == other.discs
    }

    /// Whether a point is inside a disc.
    pub(crate) fn contain(&self, at: Point) -> bool {
        self.containing(at).next().is_some()
    }

    fn containing(&self, at: Point) -> impl Iterator<Item = &Disc> {
        let discs = self.discs.iter();
        discs.filter(move |disc| disc.centre.to(at).length() < disc.radius_m)
    }

    /// Whether a straight line enters no disc, and only leads outwards in the discs in which it begins.
    pub(crate) fn are_clear_between(&self, from: Point, to: Point) -> bool {
        let line = Segment { from, to };
        self.discs.iter().all(|disc| {
            let min_m = disc.radius_m.min(disc.centre.to(from).length());
            line.distance_m(disc.centre) >= min_m - ROUNDING_M
        })
    }

    /// The cells that paths do not cross, some more than once. With `is_wide`, the line between two neighbours of
    /// the other cells enters no disc; without it, the centres of the others are outside all discs.
    pub(crate) fn cells(&self, field: &Field, is_wide: bool) -> impl Iterator<Item = usize> {
        let half_m2 = if is_wide {
            field.cell_m * field.cell_m / 2.0
        } else {
            0.0
        };
        self.discs.iter().flat_map(move |disc| {
            let radius_m = libm::sqrt(disc.radius_m * disc.radius_m + half_m2);
            let reach = Point {
                x: radius_m,
                y: radius_m,
            };
            let low = reach.to(disc.centre);
            let [columns, rows] = field.columns_and_rows(low, disc.centre.plus(reach));
            let all = rows.flat_map(move |row| {
                let columns = columns.clone();
                columns.map(move |column| row * field.columns + column)
            });
            all.filter(move |cell| disc.centre.to(field.centre(*cell)).length() < radius_m)
        })
    }

    /// The radius of the largest disc; 0 without discs.
    pub(crate) fn max_radius_m(&self) -> f64 {
        let radii = self.discs.iter().map(|disc| disc.radius_m);
        radii.fold(0.0, f64::max)
    }

    /// The end of a path that is nearest to a robot, among those within a tolerance of a goal and outside all discs;
    /// `None` if there is none for which `is_open` holds.
    pub(crate) fn end(
        &self,
        (goal, tolerance_m): (Point, f64),
        robot: Point,
        is_open: impl Fn(Point) -> bool,
    ) -> Option<Point> {
        let towards = goal.to(robot);
        let first_rad = libm::atan2(towards.y, towards.x);
        let directions = (0..ENDS).map(|number| {
            let turned_rad = TAU * f64::from(number) / f64::from(ENDS);
            direction(first_rad + turned_rad)
        });
        let ends = directions.filter_map(|way| self.end_along((goal, tolerance_m), way));
        let open = ends.filter(|end| is_open(*end));
        open.min_by(|one, other| {
            let away_m = |end: &Point| robot.to(*end).length();
            away_m(one).total_cmp(&away_m(other))
        })
    }

    /// The end outside all discs along a direction from a goal.
    fn end_along(&self, (goal, tolerance_m): (Point, f64), way: Point) -> Option<Point> {
        let mut out_m = 0.0_f64;
        // Each disc that contains the end moves it on, past that disc.
        for _ in 0..=self.discs.len() {
            let left_m = tolerance_m - out_m;
            if left_m.is_nan() || left_m < 2.0 * MIN_END_MARGIN_M {
                return None;
            }
            let end = goal.plus(way.times(out_m + (left_m / 2.0).min(END_MARGIN_M)));
            match self.containing(end).next() {
                None => return Some(end),
                Some(disc) => out_m = leaves_m(disc, goal, way).max(out_m),
            }
        }
        None
    }

    /// Limits the headings of a robot that enter a disc. Of the discs that contain it, only that of the nearest item
    /// counts, so that it can leave them.
    pub(crate) fn limit(&self, reachable: &mut Reachable, pose: &Pose) {
        let away_m = |disc: &Disc| disc.centre.to(pose.at).length();
        let inside = self.containing(pose.at);
        let nearest = inside.min_by(|one, other| away_m(one).total_cmp(&away_m(other)));
        let outside = self.discs.iter();
        let outside = outside.filter(|disc| away_m(disc) >= disc.radius_m);
        for disc in outside.chain(nearest) {
            reachable.limit_by_disc(pose.in_own_frame(disc.centre), disc.radius_m);
        }
    }
}

/// The distance that a robot keeps at its work from an item that may destroy it and whose position is exact; 0 if none may.
pub(crate) fn kept_m(body: &Body) -> f64 {
    let dangers = body.hazards_m.iter().flatten();
    let largest_m = dangers.copied().max_by(f64::total_cmp);
    largest_m.map_or(0.0, |danger_m| danger_m + body.radius_m + WORK_CONTROL_M)
}

/// The range of a sensor or tool of a robot below which it reaches no item from where the item cannot destroy it, for the
/// distance at which that is a danger to the footprint of the robot.
#[must_use]
pub fn min_work_range_m(danger_m: f64, radius_m: f64) -> f64 {
    danger_m + radius_m + WORK_CONTROL_M + WORK_REACH_M
}

/// The largest distance at which an item is a danger with the minimum probability, by the danger and the share of each
/// kind, and the probability that there is an item.
fn danger_m(hazards_m: &[Option<f64>], shares: &[f64], exists: f64) -> Option<f64> {
    let dangers = || hazards_m.iter().zip(shares);
    let is_likely = |danger_m: &f64| {
        let wide = dangers().filter(|(hazard_m, _)| hazard_m.is_some_and(|m| m >= *danger_m));
        exists * wide.map(|(_, share)| share).sum::<f64>() >= MIN_PROBABILITY
    };
    let distances = dangers().filter_map(|(hazard_m, _)| *hazard_m);
    distances.filter(is_likely).max_by(f64::total_cmp)
}

/// How far from a goal a direction leaves a disc.
fn leaves_m(disc: &Disc, goal: Point, way: Point) -> f64 {
    let centre = goal.to(disc.centre);
    let (along_m, aside_m) = (way.dot(centre), way.cross(centre));
    let half_m2 = disc.radius_m * disc.radius_m - aside_m * aside_m;
    along_m + libm::sqrt(half_m2.max(0.0))
}

#[cfg(test)]
mod tests;
