//! The proposals of behaviours as vectors, and the motion for a vector.

use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::navigation::navigator::stopping_speed_m_s;
use crate::perception::beliefs::Beliefs;
use crate::situation::Situation;
use base::geometry::Point;
use core::f64::consts::FRAC_PI_3;

/// The weighted mean of proposals, in units of the maximum speed of the body.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ProposalMean {
    sum: Point,
    gains: f64,
    pub(super) max_speed: f64,
}

impl ProposalMean {
    pub(super) fn add(&mut self, proposal: &Proposal, gain: Option<f64>, situation: &Situation) {
        let (vector, max_speed, default_gain) = match proposal {
            Proposal::Motion(motion) => {
                let vector = motion_vector(*motion, situation.body);
                (vector, vector.length(), 1.0)
            }
            Proposal::Destination(destination) => {
                let (vector, max_speed) = destination_vector(destination, situation);
                (vector, max_speed, destination.value)
            }
        };
        let gain = gain.unwrap_or(default_gain);
        self.sum = self.sum.plus(vector.times(gain));
        self.gains += gain;
        if gain > 0.0 {
            self.max_speed = self.max_speed.max(max_speed);
        }
    }

    pub(super) fn mean(&self) -> Point {
        self.sum.times(1.0 / self.gains.max(f64::MIN_POSITIVE))
    }
}

/// A motion as a vector of length 0 to 1.
fn motion_vector(motion: Motion, body: &Body) -> Point {
    let fraction = |value: f64, max: f64| {
        if max > 0.0 {
            (value / max).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    };
    let vector = Point {
        x: fraction(motion.speed_m_s, body.max_speed_m_s),
        y: fraction(motion.turn_rate_rad_s, body.max_turn_rate_rad_s),
    };
    vector.times(1.0 / vector.length().max(1.0))
}

/// A destination as a vector, and the maximum speed from which the robot still stops there.
fn destination_vector(destination: &Destination, situation: &Situation) -> (Point, f64) {
    let max_m_s = situation.body.max_speed_m_s;
    let Some(pose) = situation.beliefs.and_then(Beliefs::pose) else {
        return (Point::default(), 0.0);
    };
    let line = pose.in_own_frame(destination.at);
    let distance_m = line.length();
    if distance_m <= 0.0 || max_m_s <= 0.0 {
        return (Point::default(), 0.0);
    }
    let speed = (destination.max_speed_m_s / max_m_s).clamp(0.0, 1.0);
    let stop_within_m = distance_m - destination.tolerance_m / 2.0;
    let stopping_m_s = stopping_speed_m_s(stop_within_m, situation);
    (
        line.times(speed / distance_m),
        speed.min(stopping_m_s / max_m_s),
    )
}

/// The motion in the direction of a vector, as fast as it is long, up to `max_speed`; the robot
/// first turns to that direction.
pub(super) fn along(sum: Point, max_speed: f64, body: &Body) -> Motion {
    let turn_rad = libm::atan2(sum.y, sum.x);
    let aligned = (1.0 - turn_rad.abs() / FRAC_PI_3).max(0.0);
    Motion {
        speed_m_s: body.max_speed_m_s * sum.length().min(max_speed) * aligned,
        turn_rate_rad_s: turn_rad / body.period_s,
    }
}
