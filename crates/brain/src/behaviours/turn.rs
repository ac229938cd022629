//! A turn on the spot.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::situation::Situation;

/// Tolerance at which a turn is complete, in radians.
const DONE_RAD: f32 = 0.02;

/// Turn rate assumed for a robot that cannot turn, in rad/s.
const MAX_DURATION_S: f64 = 60.0;

/// A turn on the spot in progress.
///
/// Works without a compass, by time; a compass makes it more accurate.
#[derive(Debug, Clone)]
pub(crate) struct Turn {
    /// Anticlockwise.
    left_rad: f32,
    patience_s: f32,
}

impl Turn {
    /// A turn by an anticlockwise angle, and its first motion.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn by(angle_rad: f64, body: &Body) -> (Self, Motion) {
        // Times out after twice its duration plus one second, in case the robot is blocked.
        let patience_s = 1.0 + 2.0 * angle_rad.abs() / body.max_turn_rate_rad_s;
        let turn = Self {
            left_rad: angle_rad as f32,
            patience_s: patience_s.min(MAX_DURATION_S) as f32,
        };
        (turn, on_the_spot(angle_rad, body))
    }

    /// The next motion; `None` if the turn is complete or has timed out.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn next_motion(&mut self, situation: &Situation) -> Option<Motion> {
        self.left_rad -= situation.turned_rad as f32;
        if !situation.is_held() {
            self.patience_s -= situation.step_s();
        }
        let is_done = self.left_rad.abs() <= DONE_RAD || self.patience_s <= 0.0;
        (!is_done).then(|| on_the_spot(f64::from(self.left_rad), situation.body))
    }
}

/// The maximum turn rate that does not overshoot before the next step.
fn on_the_spot(left_rad: f64, body: &Body) -> Motion {
    Motion {
        speed_m_s: 0.0,
        turn_rate_rad_s: left_rad / body.period_s,
    }
}
