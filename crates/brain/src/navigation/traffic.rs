//! Keeping out of each other's way.
//!
//! Whoever moves has a stopping way: from where it is to where it stands if it brakes now. Between the
//! stopping ways of two robots runs the line that is as far from both as can be. **Each keeps its next
//! stopping way on its own side of that line**, half of both radii away from it. Braking always does:
//! the rest of a stopping way is part of it. So whatever two robots want that both follow this rule,
//! they never meet, and nobody needs to know what the other wants; a robot that stands may turn.
//!
//! ```text
//!      me ----> |     /          The line stands across the shortest way between the
//!               | gap           two stopping ways. Who comes from the side may pass
//!               |     \          along it.
//!   <- stopping | stopping <---- other
//! ```
//!
//! Others see where one went in the last step, not where he points at its end. Who turns while he goes
//! therefore leaves as much more room as the end of his stopping way is aside of where others see it.
//! What crosses cannot be kept apart: then both brake.
//!
//! The idea is that of buffered Voronoi cells (Zhou, Wang, Bandyopadhyay and Schwager, *Fast, on-line
//! collision avoidance for dynamic vehicles using buffered Voronoi cells*, 2017), which are between
//! points and hold for bodies that stop at once; here they are between stopping ways.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::beliefs::mover::Mover;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};

/// Room between two hulls, in metres, besides what sensors err by.
const ROOM_M: f64 = 0.02;

/// It counts on this share of its brakes, and on others' too.
const BRAKING: f64 = 0.9;

/// Positions may err by so many standard deviations.
const DEVIATIONS: f64 = 3.0;

/// A line that must not be crossed: what it keeps apart is `normal . point <= most`.
#[derive(Debug, Clone, Copy)]
struct Line {
    normal: Point,
    most: f64,
}

/// The lines towards all others nearby.
#[derive(Debug, Clone, Default)]
pub(crate) struct Traffic {
    lines: Vec<Line>,
}

impl Traffic {
    /// Draws the lines anew, for a robot that goes at a speed and has turned in its last step.
    pub(crate) fn look(&mut self, movers: &[Mover], body: &Body, [now_m_s, turned_rad]: [f64; 2]) {
        self.lines.clear();
        let own = stopping_way(body, Point::default(), now_m_s, 0.0);
        let lag_m = lag_m(&own, turned_rad);
        for mover in movers {
            self.lines.extend(line(&own, lag_m, mover, body));
        }
    }

    /// What of a motion keeps to all lines: slower, or straight on while it brakes.
    pub(crate) fn limited(&self, wanted: Motion, body: &Body, now_m_s: f64) -> Motion {
        let is_turning_only = now_m_s == 0.0 && wanted.speed_m_s == 0.0;
        if self.lines.is_empty() || is_turning_only {
            return wanted;
        }
        for turn in [1.0, 0.5, 0.0] {
            for share in [1.0, 0.75, 0.5, 0.25, 0.0] {
                let motion = Motion {
                    speed_m_s: wanted.speed_m_s * share,
                    turn_rate_rad_s: wanted.turn_rate_rad_s * turn,
                };
                if self.keeps(motion, body, now_m_s) {
                    return motion;
                }
            }
        }
        Motion {
            speed_m_s: 0.0,
            turn_rate_rad_s: if now_m_s == 0.0 {
                wanted.turn_rate_rad_s
            } else {
                0.0
            },
        }
    }

    /// Whether the stopping way after a step of a motion is on this side of every line.
    fn keeps(&self, motion: Motion, body: &Body, now_m_s: f64) -> bool {
        let period_s = body.period_s;
        let most_m_s = body.max_acceleration_m_s2 * period_s;
        let change_m_s = (motion.speed_m_s - now_m_s).max(-most_m_s).min(most_m_s);
        let then_m_s = now_m_s + change_m_s;
        let change_s = change_m_s.abs() / body.max_acceleration_m_s2;
        let turned_rad = motion.turn_rate_rad_s * period_s;
        // At once to the new speed, as far as that goes, and then on with it.
        let way_m = then_m_s * period_s - change_m_s * change_s / 2.0;
        let there = direction(turned_rad / 2.0).times(way_m);
        let stopping = stopping_way(body, there, then_m_s, turned_rad);
        let bulge_m = (way_m * turned_rad / 8.0).abs();
        let lag_m = lag_m(&stopping, turned_rad) + bulge_m;
        [stopping.from, stopping.to].iter().all(|place| {
            let mut lines = self.lines.iter();
            lines.all(|line| line.normal.dot(*place) <= line.most - lag_m)
        })
    }
}

/// So far aside others see the end of a stopping way after a turn: they know where one went in the step,
/// not where he points at its end.
fn lag_m(stopping: &Segment, turned_rad: f64) -> f64 {
    stopping.length_m() * turned_rad.abs() / 2.0
}

/// From a place to where it stands if it brakes there.
fn stopping_way(body: &Body, from: Point, speed_m_s: f64, heading_rad: f64) -> Segment {
    let braking = BRAKING * body.max_acceleration_m_s2;
    let stopping_m = speed_m_s * speed_m_s.abs() / (2.0 * braking);
    Segment {
        from,
        to: from.plus(direction(heading_rad).times(stopping_m)),
    }
}

/// The line between this robot's stopping way and that of another.
///
/// The other's speed was measured over its last step: it may have grown in it by half of what it can.
fn line(own: &Segment, lag_m: f64, mover: &Mover, body: &Body) -> Option<Line> {
    let braking = BRAKING * mover.braking_m_s2;
    let speed_m_s = mover.speed_m_s();
    let now_m_s = if speed_m_s > 0.0 && braking.is_finite() {
        speed_m_s + mover.braking_m_s2 * body.period_s / 2.0
    } else {
        speed_m_s
    };
    let stopping_s = now_m_s / (2.0 * braking);
    let ahead = mover.velocity_m_s.times(stopping_s);
    let other = Segment {
        from: mover.at,
        to: mover.at.plus(ahead),
    };
    let (here, there) = nearest(own, &other);
    let between = here.to(there);
    let gap_m = between.length();
    if gap_m <= 0.0 {
        // They cross: all that is left is to brake.
        let is_anybody_moving = own.length_m() + other.length_m() > 0.0;
        return is_anybody_moving.then_some(Line {
            normal: Point::default(),
            most: f64::NEG_INFINITY,
        });
    }
    let normal = between.times(1.0 / gap_m);
    let error_m = DEVIATIONS * body.neighbour_noise_m;
    let half_m = (body.radius_m + mover.radius_m + ROOM_M + error_m) / 2.0;
    // Who is too near already must not come nearer, nor to one of whom nobody knows how fast he goes.
    let left_m = if mover.looks > 1 {
        (gap_m / 2.0 - half_m - lag_m).max(0.0)
    } else {
        0.0
    };
    Some(Line {
        normal,
        most: normal.dot(here) + left_m,
    })
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
