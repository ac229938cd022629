//! Giving way: what to do when robots block each other.
//!
//! Robots that meet head-on in an aisle keep right. Where that is not enough, the one on the
//! left-hand side reverses and lets the other pass. A robot that is still blocked takes a random
//! heading for a while, each time for longer, until the deadlock is resolved (Yuta and Premvuti,
//! *Coordinating autonomous and centralized decision making to achieve cooperative behaviors
//! between multiple mobile robots*, IROS 1992, call the reversing "shunting"; the growing times are
//! the exponential backoff of Metcalfe and Boggs, *Ethernet*, 1976).

use crate::io::random_words::RandomWords;
use crate::perception::beliefs::mover::Mover;
use crate::perception::rays::Ray;
use crate::perception::sector::direction;
use base::geometry::Point;
use base::hashed::Hashed;
use base::trig::wrapped;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// A robot is blocked while its path shortens at less than this fraction of its maximum speed.
///
/// The path, not the distance: a path around a wall leads away from the goal.
const MIN_PROGRESS: f64 = 0.2;

/// A blocked robot gives way after this time, in seconds: half of it on the left-hand side of an
/// aisle, three times as much on the right-hand side.
const PATIENCE_S: f64 = 2.0;

/// It gives way for this time, in seconds.
const YIELD_S: f64 = 2.0;

/// Each time multiplies the duration by `BACKOFF`, up to `MAX_BACKOFF` in total.
const BACKOFF: f64 = 1.5;
const MAX_BACKOFF: f64 = 6.0;

/// Robots and walls farther away than this do not matter, in metres.
const NEAR_M: f64 = 2.0;

/// Angle by which a robot keeps right of an oncoming one.
const KEEP_RIGHT_RAD: f64 = 0.2;

/// An oncoming robot that passes farther aside than this does not matter, in metres.
const PASSING_M: f64 = 1.5;

/// A goal that moves by less than this remains the same goal, in metres.
const SAME_GOAL_M: f64 = 1.0;

/// Sides of an aisle that differ by less than this are equally wide, in metres.
const SAME_WIDTH_M: f64 = 0.1;

/// One robot's memory of its progress.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Shunting {
    /// The goal of the last step, and the path length to it.
    goal: Point,
    remaining_m: f64,
    blocked_s: f64,
    /// Random factor of its patience, 0.5 to 1.5.
    patience: f64,
    /// Remaining time for which it gives way, and the heading for it, relative to its front.
    yield_s: f64,
    yield_rad: f64,
    backoff: f64,
}

impl Default for Shunting {
    fn default() -> Self {
        Self {
            goal: Point::default(),
            remaining_m: f64::INFINITY,
            blocked_s: 0.0,
            patience: 1.0,
            yield_s: 0.0,
            yield_rad: 0.0,
            backoff: 1.0,
        }
    }
}

/// The situation of one step.
pub(crate) struct Step<'s> {
    /// In world coordinates.
    pub(crate) goal: Point,
    /// The next waypoint, relative to the robot's front.
    pub(crate) target: Point,
    /// Path length to the goal.
    pub(crate) remaining_m: f64,
    pub(crate) turned_rad: f64,
    pub(crate) elapsed_s: f64,
    pub(crate) max_speed_m_s: f64,
    pub(crate) hits: &'s [Ray],
    pub(crate) movers: &'s [Mover],
}

impl Step<'_> {
    fn target_rad(&self) -> f64 {
        libm::atan2(self.target.y, self.target.x)
    }
}

impl Shunting {
    /// The target to steer for instead of that of the step, relative to the robot's front.
    pub(crate) fn redirect(&mut self, step: &Step, mut random: RandomWords) -> Point {
        self.yield_rad = wrapped(self.yield_rad - step.turned_rad);
        let progress_m = self.remaining_m - step.remaining_m;
        let is_new_goal = self.goal.to(step.goal).length() > SAME_GOAL_M;
        self.goal = step.goal;
        if is_new_goal {
            self.blocked_s = 0.0;
        } else if self.yield_s > 0.0 {
            self.yield_s -= step.elapsed_s;
        } else {
            self.watch_progress(progress_m, step);
        }
        self.remaining_m = step.remaining_m;
        if self.yield_s <= 0.0 && self.is_out_of_patience(step) {
            self.start_yielding(step, &mut random);
        }
        if self.yield_s > 0.0 {
            return direction(self.yield_rad).times(NEAR_M);
        }
        keep_right(step)
    }

    pub(crate) fn is_yielding(&self) -> bool {
        self.yield_s > 0.0
    }

    fn watch_progress(&mut self, progress_m: f64, step: &Step) {
        if is_turning_to_target(step) {
            return;
        }
        if progress_m < MIN_PROGRESS * step.max_speed_m_s * step.elapsed_s {
            self.blocked_s += step.elapsed_s;
        } else {
            self.blocked_s = (self.blocked_s - 2.0 * step.elapsed_s).max(0.0);
            self.backoff = (self.backoff - 0.1 * step.elapsed_s).max(1.0);
        }
    }

    fn is_out_of_patience(&self, step: &Step) -> bool {
        let factor = match side(step) {
            Side::Left => 0.5,
            Side::Right => 3.0,
            Side::Neither => 1.0,
        };
        self.blocked_s > factor * PATIENCE_S * self.patience
    }

    fn start_yielding(&mut self, step: &Step, random: &mut RandomWords) {
        let target_rad = step.target_rad();
        self.yield_rad = wrapped(match side(step) {
            Side::Left => target_rad + PI + KEEP_RIGHT_RAD,
            _ => away_rad(step, target_rad) + random.between(-FRAC_PI_2, FRAC_PI_2) - 0.3,
        });
        self.yield_s = YIELD_S * self.backoff * random.between(0.5, 1.5);
        self.backoff = (self.backoff * BACKOFF).min(MAX_BACKOFF);
        self.blocked_s = 0.0;
        self.patience = random.between(0.5, 1.5);
    }
}

/// Whether the robot still turns to its target: it makes no progress then, though nothing blocks
/// it.
fn is_turning_to_target(step: &Step) -> bool {
    let target_rad = step.target_rad();
    target_rad.abs() > FRAC_PI_4 && step.turned_rad * target_rad > 0.0
}

/// The side of an aisle on which a robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
    Neither,
}

fn side(step: &Step) -> Side {
    let target_rad = step.target_rad();
    let [left_m, right_m] = [FRAC_PI_2, -FRAC_PI_2].map(|side_rad| {
        let is_there =
            |hit: &&Ray| wrapped(hit.bearing_rad - target_rad - side_rad).abs() < FRAC_PI_4;
        let ranges_m = step.hits.iter().filter(is_there).map(|hit| hit.range_m);
        ranges_m.fold(NEAR_M, f64::min)
    });
    if right_m > left_m + SAME_WIDTH_M {
        Side::Left
    } else if left_m > right_m + SAME_WIDTH_M {
        Side::Right
    } else {
        Side::Neither
    }
}

/// The bearing away from movers nearby; back if there are none.
fn away_rad(step: &Step, target_rad: f64) -> f64 {
    let near = step.movers.iter().map(|mover| mover.at);
    let near = near.filter(|at| (1e-6..NEAR_M).contains(&at.length()));
    let away = near.fold(Point::default(), |away, at| {
        let distance_m = at.length();
        away.plus(at.times(-1.0 / (distance_m * distance_m * distance_m)))
    });
    if away.length_squared() > 1e-12 {
        libm::atan2(away.y, away.x)
    } else {
        target_rad + PI
    }
}

/// The target, or a point to the right of it if another robot is oncoming.
fn keep_right(step: &Step) -> Point {
    let length_m = step.target.length();
    if length_m <= 0.0 {
        return step.target;
    }
    let forward = step.target.times(1.0 / length_m);
    let is_oncoming = |mover: &Mover| {
        let is_ahead = mover.at.dot(forward) > 0.0 && mover.at.cross(forward).abs() < PASSING_M;
        is_ahead && mover.course.dot(forward) < -0.5
    };
    if step.movers.iter().any(is_oncoming) {
        let right = direction(-KEEP_RIGHT_RAD);
        crate::perception::beliefs::pose::turned(step.target, right)
    } else {
        step.target
    }
}

#[cfg(test)]
mod tests;
