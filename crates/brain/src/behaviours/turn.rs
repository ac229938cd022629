//! A turn on the spot.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::situation::Situation;

/// A turn that is done but for this is done.
const DONE_RAD: f32 = 0.02;

/// For one who cannot turn.
const MOST_PATIENCE_S: f64 = 60.0;

/// A turn on the spot that has begun.
///
/// Needs no compass: it lasts for as long as the angle takes, and is better with one.
#[derive(Debug, Clone)]
pub(crate) struct Turn {
    /// Anticlockwise.
    left_rad: f32,
    patience_s: f32,
}

impl Turn {
    /// A turn by an angle, anticlockwise, and how it begins.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn by(angle_rad: f64, body: &Body) -> (Self, Motion) {
        // Twice the time that it takes, and a second, in case that it is stuck.
        let patience_s = 1.0 + 2.0 * angle_rad.abs() / body.max_turn_rate_rad_s;
        let turn = Self {
            left_rad: angle_rad as f32,
            patience_s: patience_s.min(MOST_PATIENCE_S) as f32,
        };
        (turn, on_the_spot(angle_rad, body))
    }

    /// How it goes on; `None` if it is done, or has lost patience.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn go_on(&mut self, situation: &Situation) -> Option<Motion> {
        self.left_rad -= situation.turned_rad as f32;
        if !situation.is_held() {
            self.patience_s -= situation.period_s();
        }
        let is_done = self.left_rad.abs() <= DONE_RAD || self.patience_s <= 0.0;
        (!is_done).then(|| on_the_spot(f64::from(self.left_rad), situation.body))
    }
}

/// As fast as it can without going too far before the next step.
fn on_the_spot(left_rad: f64, body: &Body) -> Motion {
    Motion {
        speed_m_s: 0.0,
        turn_rate_rad_s: left_rad / body.period_s,
    }
}
