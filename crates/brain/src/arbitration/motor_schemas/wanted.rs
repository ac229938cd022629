//! What behaviours want as vectors, and back.

use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::navigation::navigator::stopping_m_s;
use crate::perception::beliefs::Beliefs;
use crate::perception::situation::Situation;
use base::geometry::Point;
use core::f64::consts::FRAC_PI_3;

/// What behaviours want together, in units of the fastest that the body can.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GoalState {
    sum: Point,
    gains: f64,
    /// No faster than this.
    pub(super) most: f64,
}

impl GoalState {
    pub(super) fn add(&mut self, proposal: &Proposal, gain: Option<f64>, situation: &Situation) {
        let (vector, most, usual) = match proposal {
            Proposal::Motion(motion) => {
                let vector = of_motion(*motion, situation.body);
                (vector, vector.length(), 1.0)
            }
            Proposal::Destination(aim) => {
                let (vector, most) = of_aim(aim, situation);
                (vector, most, aim.value)
            }
        };
        let gain = gain.unwrap_or(usual);
        self.sum = self.sum.plus(vector.times(gain));
        self.gains += gain;
        if gain > 0.0 {
            self.most = self.most.max(most);
        }
    }

    pub(super) fn mean(&self) -> Point {
        self.sum.times(1.0 / self.gains.max(f64::MIN_POSITIVE))
    }
}

/// A motion as a vector, at most 1 long.
fn of_motion(motion: Motion, body: &Body) -> Point {
    let share = |value: f64, most: f64| {
        if most > 0.0 {
            (value / most).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    };
    let vector = Point {
        x: share(motion.speed_m_s, body.max_speed_m_s),
        y: share(motion.turn_rate_rad_s, body.max_turn_rate_rad_s),
    };
    vector.times(1.0 / vector.length().max(1.0))
}

/// An aim as a vector, and the speed with which it still stops there.
fn of_aim(aim: &Destination, situation: &Situation) -> (Point, f64) {
    let fastest_m_s = situation.body.max_speed_m_s;
    let Some(pose) = situation.beliefs.and_then(Beliefs::pose) else {
        return (Point::default(), 0.0);
    };
    let way = pose.own(aim.to);
    let away_m = way.length();
    if away_m <= 0.0 || fastest_m_s <= 0.0 {
        return (Point::default(), 0.0);
    }
    let share = (aim.speed_m_s / fastest_m_s).clamp(0.0, 1.0);
    let most_m_s = stopping_m_s(away_m - aim.within_m / 2.0, situation);
    (way.times(share / away_m), share.min(most_m_s / fastest_m_s))
}

/// To where a vector points, as fast as it is long, up to `most`; who looks elsewhere turns first.
pub(super) fn along(sum: Point, most: f64, body: &Body) -> Motion {
    let turn_rad = libm::atan2(sum.y, sum.x);
    let aligned = (1.0 - turn_rad.abs() / FRAC_PI_3).max(0.0);
    Motion {
        speed_m_s: body.max_speed_m_s * sum.length().min(most) * aligned,
        turn_rate_rad_s: turn_rad / body.period_s,
    }
}
