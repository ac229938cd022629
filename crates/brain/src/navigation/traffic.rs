//! Collision avoidance between robots.
//!
//! A moving robot has a stopping path: from its position to where it stands if it brakes now. A
//! line separates the stopping paths of two robots, half way between their nearest points. **Each
//! robot keeps its next stopping path on its own side of that line**, at a distance of half the sum
//! of both radii. Braking always satisfies this: the rest of a stopping path is part of it. So
//! robots that both follow this rule never collide for any proposed motions, and neither needs to
//! know the proposal of the other. A stationary robot may turn.
//!
//! ```text
//!          stopping path         |         stopping path
//!   robot ----------------->     |     <----------------- other robot
//!                            gap / 2   gap / 2
//! ```
//!
//! The line is perpendicular to the shortest connection of the two paths: a robot that comes from
//! the side may pass along it.
//!
//! Others observe the direction of a robot's last motion, not its heading at the end of the step. A
//! robot that turns while it moves therefore leaves additional room: the lateral distance between
//! the end of its stopping path and where others assume it. If two stopping paths cross, they
//! cannot be separated: then both robots brake.
//!
//! The idea is that of buffered Voronoi cells (Zhou, Wang, Bandyopadhyay and Schwager, *Fast,
//! on-line collision avoidance for dynamic vehicles using buffered Voronoi cells*, 2017), which
//! separate points and hold for robots that stop at once; here they separate stopping paths.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::navigation::speed_governor::BRAKING;
use crate::perception::beliefs::mover::Mover;
use crate::perception::dead_reckoning::Odometry;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};
use base::hashed::Hashed;

/// Clearance between two robots in addition to the sensor error, in metres.
const CLEARANCE_M: f64 = 0.02;

/// Allowance for the error of positions, in standard deviations.
const DEVIATIONS: f64 = 3.0;

/// A line that the robot must not cross: points on its side satisfy `normal . point <= max`.
#[derive(Debug, Clone, Copy, Hashed)]
struct Line {
    normal: Point,
    max: f64,
}

/// The lines between this robot and all others nearby.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Traffic {
    lines: Vec<Line>,
}

impl Traffic {
    /// Computes the lines for a robot with a current speed and a turn in its last step.
    pub(crate) fn update(&mut self, movers: &[Mover], body: &Body, odometry: &Odometry) {
        self.lines.clear();
        let own = stopping_path(body, Point::default(), odometry.speed_m_s, 0.0);
        let lag_m = lag_m(&own, odometry.turned_rad);
        for mover in movers {
            self.lines
                .extend(line((&own, lag_m), mover, body, odometry.elapsed_s));
        }
    }

    /// The motion nearest to the proposed one that keeps to all lines: slower, with less of a turn,
    /// or braking straight ahead.
    pub(crate) fn limit(&self, setpoint: Motion, body: &Body, current_speed_m_s: f64) -> Motion {
        let is_turning_only = current_speed_m_s == 0.0 && setpoint.speed_m_s == 0.0;
        if self.lines.is_empty() || is_turning_only {
            return setpoint;
        }
        for turn in [1.0, 0.5, 0.0] {
            for speed in [1.0, 0.75, 0.5, 0.25, 0.0] {
                let motion = Motion {
                    speed_m_s: setpoint.speed_m_s * speed,
                    turn_rate_rad_s: setpoint.turn_rate_rad_s * turn,
                };
                if self.allows(motion, body, current_speed_m_s) {
                    return motion;
                }
            }
        }
        Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: if current_speed_m_s == 0.0 {
                setpoint.turn_rate_rad_s
            } else {
                0.0
            },
        }
    }

    /// Whether the stopping path after one step of a motion is on this side of every line.
    fn allows(&self, motion: Motion, body: &Body, current_speed_m_s: f64) -> bool {
        let period_s = body.period_s;
        let max_change_m_s = body.max_acceleration_m_s2 * period_s;
        let change_m_s = (motion.speed_m_s - current_speed_m_s)
            .max(-max_change_m_s)
            .min(max_change_m_s);
        let then_m_s = current_speed_m_s + change_m_s;
        let change_s = change_m_s.abs() / body.max_acceleration_m_s2;
        let turned_rad = motion.turn_rate_rad_s * period_s;
        // It accelerates at the start of the step, and then keeps the new speed.
        let distance_m = then_m_s * period_s - change_m_s * change_s / 2.0;
        let position = direction(turned_rad / 2.0).times(distance_m);
        let stopping = stopping_path(body, position, then_m_s, turned_rad);
        let bulge_m = (distance_m * turned_rad / 8.0).abs();
        let lag_m = lag_m(&stopping, turned_rad) + bulge_m;
        [stopping.from, stopping.to].iter().all(|end| {
            let mut lines = self.lines.iter();
            lines.all(|line| line.normal.dot(*end) <= line.max - lag_m)
        })
    }
}

/// Lateral distance, after a turn, between the end of a stopping path and where others assume it:
/// they know the direction of the motion in the step, not the heading at its end.
fn lag_m(stopping: &Segment, turned_rad: f64) -> f64 {
    stopping.length_m() * turned_rad.abs() / 2.0
}

fn stopping_path(body: &Body, from: Point, speed_m_s: f64, heading_rad: f64) -> Segment {
    let braking = BRAKING * body.max_acceleration_m_s2;
    let stopping_m = speed_m_s * speed_m_s.abs() / (2.0 * braking);
    Segment {
        from,
        to: from.plus(direction(heading_rad).times(stopping_m)),
    }
}

/// The line between this robot's stopping path and that of another.
///
/// The other's speed is an average over its last step: since then, it may have increased by half of
/// what its acceleration allows.
fn line((own, lag_m): (&Segment, f64), mover: &Mover, body: &Body, elapsed_s: f64) -> Option<Line> {
    let braking = BRAKING * mover.braking_m_s2;
    let speed_m_s = mover.speed_m_s();
    let current_speed_m_s = if speed_m_s > 0.0 && braking.is_finite() {
        speed_m_s + mover.braking_m_s2 * elapsed_s / 2.0
    } else {
        speed_m_s
    };
    let stopping_s = current_speed_m_s / (2.0 * braking);
    let ahead = mover.velocity_m_s.times(stopping_s);
    let other = Segment {
        from: mover.at,
        to: mover.at.plus(ahead),
    };
    let (here, there) = nearest(own, &other);
    let between = here.to(there);
    let gap_m = between.length();
    if gap_m <= 0.0 {
        // The paths cross. No motion satisfies this line, so that the robot brakes.
        let is_any_moving = own.length_m() + other.length_m() > 0.0;
        return is_any_moving.then_some(Line {
            normal: Point::default(),
            max: f64::NEG_INFINITY,
        });
    }
    let normal = between.times(1.0 / gap_m);
    let error_m = DEVIATIONS * body.neighbour_noise_m;
    let unseen_m = unseen_m(mover, body, elapsed_s);
    let apart_m = body.radius_m + mover.radius_m + CLEARANCE_M;
    let half_gap_m = (apart_m + error_m + unseen_m) / 2.0;
    // Robots that are too near already must not come nearer. The same holds for a mover that was
    // observed only once, whose velocity is unknown.
    let free_m = if mover.observations > 1 {
        (gap_m / 2.0 - half_gap_m - lag_m).max(0.0)
    } else {
        0.0
    };
    Some(Line {
        normal,
        max: normal.dot(here) + free_m,
    })
}

/// How far another robot may be from where a late observation predicts it, at most.
///
/// Since the observation it may have accelerated and turned, and it may brake from the speed that it
/// has then. What is not known of others is assumed to be as for this robot: the turn rate, and the
/// maximum speed.
fn unseen_m(mover: &Mover, body: &Body, elapsed_s: f64) -> f64 {
    let age_s = mover.age_s;
    if age_s <= 0.0 {
        return 0.0;
    }
    let max_m_s = body.max_speed_m_s.max(mover.speed_m_s());
    let gained_m_s = |time_s: f64| (mover.braking_m_s2 * time_s).min(max_m_s);
    let then_m_s = (mover.speed_m_s() + gained_m_s(age_s + elapsed_s)).min(max_m_s);
    // Its direction differs by the length of a chord of the unit circle, at most.
    let turned = (body.max_turn_rate_rad_s * (age_s + elapsed_s)).min(2.0);
    let moved_m = (gained_m_s(age_s / 2.0 + elapsed_s) + then_m_s * turned / 2.0) * age_s;
    let stopping_m = |speed_m_s: f64| speed_m_s * speed_m_s / (2.0 * BRAKING * mover.braking_m_s2);
    let longer_m = stopping_m(then_m_s) - stopping_m(mover.speed_m_s());
    moved_m + longer_m.max(0.0) + stopping_m(then_m_s) * turned
}

/// The nearest points of two segments.
fn nearest(one: &Segment, other: &Segment) -> (Point, Point) {
    let ends = [
        (one.from, other.nearest(one.from)),
        (one.to, other.nearest(one.to)),
        (one.nearest(other.from), other.from),
        (one.nearest(other.to), other.to),
    ];
    let distance = |(here, there): &(Point, Point)| here.to(*there).length_squared();
    let nearer = |best, pair| {
        if distance(&pair) < distance(&best) {
            pair
        } else {
            best
        }
    };
    ends.into_iter().fold(ends[0], nearer)
}

#[cfg(test)]
mod tests;
