//! A turn on the spot.

use crate::io::body::Body;
use crate::io::command::Motion;
use crate::perception::beliefs::Localisation;
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

    /// Changes the angle that is left to the difference from a heading.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn aim(&mut self, left_rad: f64, situation: &Situation) {
        // The next motion takes it off again.
        self.left_rad = (left_rad + situation.turned_rad) as f32;
    }

    /// The next motion; `None` if the turn is complete or has timed out.
    ///
    /// A body whose drive follows with a lag turns on for a while: a turn is complete when it ends where
    /// it should, as far as the robot knows its heading.
    #[expect(clippy::cast_possible_truncation, reason = "kept short")]
    pub(super) fn next_motion(&mut self, situation: &Situation) -> Option<Motion> {
        self.left_rad -= situation.turned_rad as f32;
        if !situation.is_held() {
            self.patience_s -= situation.step_s();
        }
        let off_rad = self.left_rad - situation.coasting_rad() as f32;
        let is_done = off_rad.abs() <= done_rad(situation) || self.patience_s <= 0.0;
        (!is_done).then(|| on_the_spot(f64::from(off_rad), situation.body))
    }
}

/// The tolerance of a turn: at least the standard deviation of the heading.
#[expect(clippy::cast_possible_truncation, reason = "kept short")]
fn done_rad(situation: &Situation) -> f32 {
    let drive = situation.localisation.filter(|own| own.drive().is_some());
    let pose = drive.and_then(Localisation::pose);
    pose.map_or(DONE_RAD, |pose| DONE_RAD.max(pose.deviation_rad as f32))
}

/// The maximum turn rate that does not overshoot before the next step.
fn on_the_spot(left_rad: f64, body: &Body) -> Motion {
    Motion {
        speed_m_s: 0.0,
        turn_rate_rad_s: left_rad / body.period_s,
    }
}
