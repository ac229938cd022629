//! The utility of every place that can be reached: which way to take next.
//!
//! The robot looks along courses all around. A course leads straight on until something is in the way:
//! what stands, or what moves, if it goes on as it does. The place reached there has the utility
//!
//! ```text
//! U = -(distance left to where it wants to be) - (cost of turning there)
//! ```
//!
//! so a filled place is as bad as the way to it is short, and places nearer to the aim are better. The
//! best is taken, and the speed such that it gets there in no less than [`REACTION_S`].
//!
//! Source: Guzzi, Giusti, Gambardella, Theraulaz and Di Caro, *Human-friendly robot navigation in
//! dynamic environments*, ICRA 2013, after Moussaid, Helbing and Theraulaz, *How simple rules determine
//! pedestrian behavior and crowd disasters*, PNAS 108, 2011; there the distance left is that between
//! the aim and the place reached.

use crate::perception::beliefs::mover::Mover;
use crate::perception::rays::Ray;
use crate::perception::sector::direction;
use base::geometry::Point;
use base::trig::wrapped;
use core::array;
use core::f64::consts::{PI, TAU};

/// Courses that are looked along.
pub(crate) const COURSES: usize = 40;

/// It looks no farther ahead, in metres and in seconds of its greatest speed.
const HORIZON_M: f64 = 5.0;

/// Time that it takes at least to come to what is in the way.
const REACTION_S: f64 = 0.5;

/// Room beside others, in metres: they err too.
const MARGIN_M: f64 = 0.1;

/// Room beside what stands, in metres.
const GRAZING_M: f64 = 0.03;

/// A radian of turning costs as much as so many metres.
const TURN_M: f64 = 0.02;

/// The courses, each with how far it is free.
#[derive(Debug, Clone)]
pub(crate) struct Reachable {
    /// From the robot's front, the first ahead, anticlockwise.
    pub(crate) free_m: [f64; COURSES],
    /// Where courses lead: all that is ahead and then all that is aside, to be computed with in a row.
    ahead: [f64; COURSES],
    aside: [f64; COURSES],
}

/// The best of the courses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choice {
    /// From the robot's front.
    pub(crate) bearing_rad: f64,
    pub(crate) free_m: f64,
}

impl Default for Reachable {
    fn default() -> Self {
        let directions = array::from_fn(|course| direction(bearing_rad(course)));
        Self {
            free_m: [0.0; COURSES],
            ahead: directions.map(|way| way.x),
            aside: directions.map(|way| way.y),
        }
    }
}

/// The direction of a course, from -pi to pi.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "few")]
pub(crate) fn bearing_rad(course: usize) -> f64 {
    let turns = course as f64 / COURSES as f64;
    TAU * if turns > 0.5 { turns - 1.0 } else { turns }
}

impl Reachable {
    /// How far each course is free, for a body of this radius that goes at a speed.
    pub(crate) fn look(
        &mut self,
        hits: &[Ray],
        movers: &[Mover],
        (radius_m, speed_m_s): (f64, f64),
    ) {
        self.free_m = [HORIZON_M; COURSES];
        for hit in hits {
            self.block(hit, radius_m + GRAZING_M);
        }
        for mover in movers {
            self.meet(mover, radius_m + mover.radius_m + MARGIN_M, speed_m_s);
        }
    }

    /// What stands at a hit is in the way of the courses that come nearer to it than the body is wide.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "few"
    )]
    fn block(&mut self, hit: &Ray, radius_m: f64) {
        if hit.range_m >= HORIZON_M + radius_m {
            return;
        }
        let share = (radius_m / hit.range_m.max(1e-9)).min(1.0);
        // At most so far off does a course still touch it: asin(share), and never less.
        let most_rad = share * (1.0 + 0.571 * share * share);
        let apart_rad = TAU / COURSES as f64;
        let courses = COURSES as f64;
        let (first, last) = (
            libm::ceil((hit.bearing_rad - most_rad) / apart_rad),
            libm::floor((hit.bearing_rad + most_rad) / apart_rad),
        );
        let at = hit.end();
        let mut course = first.max(-2.0 * courses);
        while course <= last.min(2.0 * courses) {
            let place = (course + 2.0 * courses) as usize % COURSES;
            let free_m = until_touch_m(self.direction(place), at, radius_m);
            self.free_m[place] = self.free_m[place].min(free_m);
            course += 1.0;
        }
    }

    /// Where it would meet one who goes on as it does.
    fn meet(&mut self, mover: &Mover, reach_m: f64, speed_m_s: f64) {
        let apart_m2 = mover.at.length_squared() - reach_m * reach_m;
        if apart_m2 <= 0.0 {
            for course in 0..COURSES {
                if mover.at.dot(self.direction(course)) > 0.0 {
                    self.free_m[course] = 0.0;
                }
            }
            return;
        }
        let (at, velocity) = (mover.at, mover.velocity_m_s);
        // Without a branch first, so that it is computed for several courses at once.
        let (mut closing, mut root) = ([0.0; COURSES], [0.0; COURSES]);
        for course in 0..COURSES {
            let x = velocity.x - self.ahead[course] * speed_m_s;
            let y = velocity.y - self.aside[course] * speed_m_s;
            let nearer = at.x * x + at.y * y;
            let square = nearer * nearer - (x * x + y * y) * apart_m2;
            closing[course] = nearer;
            root[course] = if nearer < 0.0 { square } else { -1.0 };
        }
        for course in 0..COURSES {
            if root[course] > 0.0 {
                let time_s = apart_m2 / (libm::sqrt(root[course]) - closing[course]);
                self.free_m[course] = self.free_m[course].min(time_s * speed_m_s);
            }
        }
    }

    /// The best way to an aim at `bearing_rad` and `away_m`.
    pub(crate) fn best(&self, aim_rad: f64, away_m: f64) -> Choice {
        self.choice(self.best_course(aim_rad, away_m), aim_rad)
    }

    /// The course that is best for that.
    #[inline]
    pub(crate) fn best_course(&self, aim_rad: f64, away_m: f64) -> usize {
        let aim = direction(aim_rad).times(away_m);
        let mut best = (f64::NEG_INFINITY, 0);
        for course in 0..COURSES {
            let left_m2 = self.reached(course, away_m).to(aim).length_squared();
            // What is farther off than the best is worth, is worth less, whatever turning costs.
            if left_m2 < best.0 * best.0 {
                let utility = utility(course, left_m2);
                if utility > best.0 {
                    best = (utility, course);
                }
            }
        }
        best.1
    }

    /// The place that is reached along a course to an aim so far away.
    #[inline]
    pub(crate) fn reached(&self, course: usize, away_m: f64) -> Point {
        self.direction(course)
            .times(self.free_m[course].min(away_m))
    }

    /// A course, or the aim itself if that is next to it.
    #[expect(clippy::cast_precision_loss, reason = "few")]
    fn choice(&self, course: usize, aim_rad: f64) -> Choice {
        let chosen_rad = bearing_rad(course);
        let is_next = wrapped(chosen_rad - aim_rad).abs() <= PI / COURSES as f64;
        Choice {
            bearing_rad: if is_next { aim_rad } else { chosen_rad },
            free_m: self.free_m[course],
        }
    }

    fn direction(&self, course: usize) -> Point {
        Point {
            x: self.ahead[course],
            y: self.aside[course],
        }
    }

    /// How far it is free straight ahead.
    pub(crate) fn ahead_m(&self) -> f64 {
        self.free_m[0]
    }
}

/// What it is worth to reach a place along a course, given the square of the distance left.
#[inline]
pub(crate) fn utility(course: usize, left_m2: f64) -> f64 {
    -libm::sqrt(left_m2) - TURN_M * bearing_rad(course).abs()
}

/// At most so fast towards what is so far.
pub(crate) fn unhurried_m_s(free_m: f64) -> f64 {
    free_m / REACTION_S
}

/// How far a disc goes along a direction until it touches a point.
fn until_touch_m(direction: Point, at: Point, radius_m: f64) -> f64 {
    let (along_m, aside_m) = (direction.dot(at), direction.cross(at));
    let square = radius_m * radius_m - aside_m * aside_m;
    if square <= 0.0 || along_m <= 0.0 {
        return f64::INFINITY;
    }
    (along_m - libm::sqrt(square)).max(0.0)
}

#[cfg(test)]
mod tests;
