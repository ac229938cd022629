//! The utility of every point that the robot can reach directly: which heading to take next.
//!
//! The robot considers headings all around itself. Each is free up to the first obstacle, or the
//! point where it would meet a mover that keeps its velocity. The point reached there has the
//! utility
//!
//! ```text
//! U = -(distance left to the target) - (cost of turning there)
//! ```
//!
//! The navigator takes the heading of the highest utility, at a speed such that the robot needs at
//! least [`REACTION_S`] to the end of the free distance.
//!
//! Source: Guzzi, Giusti, Gambardella, Theraulaz and Di Caro, *Human-friendly robot navigation in
//! dynamic environments*, ICRA 2013, after Moussaid, Helbing and Theraulaz, *How simple rules
//! determine pedestrian behavior and crowd disasters*, PNAS 108, 2011, which minimise the same
//! distance.

use crate::perception::beliefs::mover::Mover;
use crate::perception::rays::Ray;
use crate::perception::sector::direction;
use base::geometry::Point;
use base::hashed::Hashed;
use base::trig::wrapped;
use core::array;
use core::f64::consts::{PI, TAU};

/// Number of headings that are considered.
pub(crate) const HEADINGS: usize = 40;

/// Maximum free distance, in metres: obstacles farther away do not count.
const HORIZON_M: f64 = 5.0;

/// Minimum time to the end of the free distance, in seconds.
const REACTION_S: f64 = 0.5;

/// Clearance beside movers, in metres: their positions are less certain than those of obstacles.
const MOVER_MARGIN_M: f64 = 0.1;

/// Clearance beside obstacles, in metres.
const OBSTACLE_MARGIN_M: f64 = 0.03;

/// Turning by a radian costs as much as this distance, in metres.
const TURN_COST_M: f64 = 0.02;

/// The headings around a robot, each with its free distance.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Reachable {
    /// Relative to the robot's front, the first straight ahead, anticlockwise.
    pub(crate) free_m: [f64; HEADINGS],
    /// Unit vectors of the headings, in separate arrays so that loops over them vectorise.
    #[hashed(skip)]
    unit_x: [f64; HEADINGS],
    #[hashed(skip)]
    unit_y: [f64; HEADINGS],
}

/// The best of the headings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choice {
    /// Relative to the robot's front.
    pub(crate) bearing_rad: f64,
    pub(crate) free_m: f64,
}

impl Default for Reachable {
    fn default() -> Self {
        let directions = array::from_fn(|heading| direction(bearing_rad(heading)));
        Self {
            free_m: [0.0; HEADINGS],
            unit_x: directions.map(|direction| direction.x),
            unit_y: directions.map(|direction| direction.y),
        }
    }
}

/// The bearing of a heading, from -pi to pi.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "few")]
pub(crate) fn bearing_rad(heading: usize) -> f64 {
    let turns = heading as f64 / HEADINGS as f64;
    TAU * if turns > 0.5 { turns - 1.0 } else { turns }
}

impl Reachable {
    /// Computes the free distances for a robot of this radius that moves at this speed.
    pub(crate) fn update(
        &mut self,
        hits: &[Ray],
        movers: &[Mover],
        (radius_m, speed_m_s): (f64, f64),
    ) {
        self.free_m = [HORIZON_M; HEADINGS];
        for hit in hits {
            self.limit_by_obstacle(hit, radius_m + OBSTACLE_MARGIN_M);
        }
        for mover in movers {
            let contact_m = radius_m + mover.radius_m + MOVER_MARGIN_M;
            self.limit_by_mover(mover, contact_m, speed_m_s);
        }
    }

    /// Limits the headings that pass an obstacle at less than `radius_m`.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "few"
    )]
    fn limit_by_obstacle(&mut self, hit: &Ray, radius_m: f64) {
        if hit.range_m >= HORIZON_M + radius_m {
            return;
        }
        let ratio = (radius_m / hit.range_m.max(1e-9)).min(1.0);
        // An upper bound of asin(ratio): headings farther off do not touch the obstacle.
        let max_off_rad = ratio * (1.0 + 0.571 * ratio * ratio);
        let spacing_rad = TAU / HEADINGS as f64;
        let headings = HEADINGS as f64;
        let (first, last) = (
            libm::ceil((hit.bearing_rad - max_off_rad) / spacing_rad),
            libm::floor((hit.bearing_rad + max_off_rad) / spacing_rad),
        );
        let at = hit.end();
        let mut heading = first.max(-2.0 * headings);
        while heading <= last.min(2.0 * headings) {
            let index = (heading + 2.0 * headings) as usize % HEADINGS;
            let free_m = until_touch_m(self.direction(index), at, radius_m);
            self.free_m[index] = self.free_m[index].min(free_m);
            heading += 1.0;
        }
    }

    /// Limits the headings that enter a disc around a point, relative to the robot; from inside the disc, those that
    /// lead nearer to the point.
    pub(crate) fn limit_by_disc(&mut self, at: Point, radius_m: f64) {
        let centre = Ray::new(libm::atan2(at.y, at.x), at.length());
        self.limit_by_obstacle(&centre, radius_m);
    }

    /// Limits the headings that come nearer than `contact_m` to a mover that keeps its velocity.
    fn limit_by_mover(&mut self, mover: &Mover, contact_m: f64, speed_m_s: f64) {
        let clear_m2 = mover.at.length_squared() - contact_m * contact_m;
        if clear_m2 <= 0.0 {
            for heading in 0..HEADINGS {
                if mover.at.dot(self.direction(heading)) > 0.0 {
                    self.free_m[heading] = 0.0;
                }
            }
            return;
        }
        let (at, velocity) = (mover.at, mover.velocity_m_s);
        // The first loop has no branches, so that it vectorises.
        let (mut closing, mut root) = ([0.0; HEADINGS], [0.0; HEADINGS]);
        for heading in 0..HEADINGS {
            let x = velocity.x - self.unit_x[heading] * speed_m_s;
            let y = velocity.y - self.unit_y[heading] * speed_m_s;
            let nearer = at.x * x + at.y * y;
            let square = nearer * nearer - (x * x + y * y) * clear_m2;
            closing[heading] = nearer;
            root[heading] = if nearer < 0.0 { square } else { -1.0 };
        }
        for heading in 0..HEADINGS {
            if root[heading] > 0.0 {
                let time_s = clear_m2 / (libm::sqrt(root[heading]) - closing[heading]);
                self.free_m[heading] = self.free_m[heading].min(time_s * speed_m_s);
            }
        }
    }

    /// The best heading for a target at a bearing and a distance.
    pub(crate) fn best(&self, bearing_rad: f64, distance_m: f64) -> Choice {
        self.choice(self.best_heading(bearing_rad, distance_m), bearing_rad)
    }

    /// Index of the best heading for a target at a bearing and a distance.
    #[inline]
    pub(crate) fn best_heading(&self, bearing_rad: f64, distance_m: f64) -> usize {
        let target = direction(bearing_rad).times(distance_m);
        let mut best = (f64::NEG_INFINITY, 0);
        for heading in 0..HEADINGS {
            let left_m2 = self
                .reached(heading, distance_m)
                .to(target)
                .length_squared();
            // Where the distance left alone costs more than the best heading, turning need not be
            // computed.
            if left_m2 < best.0 * best.0 {
                let utility = utility(heading, left_m2);
                if utility > best.0 {
                    best = (utility, heading);
                }
            }
        }
        best.1
    }

    /// The point that is reached along a heading, no farther away than the target.
    #[inline]
    pub(crate) fn reached(&self, heading: usize, distance_m: f64) -> Point {
        self.direction(heading)
            .times(self.free_m[heading].min(distance_m))
    }

    /// A heading, or the exact bearing of the target if that lies next to it.
    #[expect(clippy::cast_precision_loss, reason = "few")]
    fn choice(&self, heading: usize, target_rad: f64) -> Choice {
        let chosen_rad = bearing_rad(heading);
        let is_next = wrapped(chosen_rad - target_rad).abs() <= PI / HEADINGS as f64;
        Choice {
            bearing_rad: if is_next { target_rad } else { chosen_rad },
            free_m: self.free_m[heading],
        }
    }

    fn direction(&self, heading: usize) -> Point {
        Point {
            x: self.unit_x[heading],
            y: self.unit_y[heading],
        }
    }

    /// Free distance straight ahead.
    pub(crate) fn ahead_m(&self) -> f64 {
        self.free_m[0]
    }
}

/// Utility of a point along a heading, from its squared distance to the target.
#[inline]
pub(crate) fn utility(heading: usize, left_m2: f64) -> f64 {
    -libm::sqrt(left_m2) - TURN_COST_M * bearing_rad(heading).abs()
}

/// Maximum speed for a free distance.
pub(crate) fn approach_speed_m_s(free_m: f64) -> f64 {
    free_m / REACTION_S
}

/// The distance that a disc moves in a direction until it touches a point.
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
