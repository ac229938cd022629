//! The pose of a body that the simulation does not move.

use super::beliefs::Localisation;
use super::beliefs::pose::Pose;
use super::dead_reckoning::DeadReckoning;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::Percept;
use base::hash::Hash;
use base::hashed::Hashed;

/// Tracks the pose of a body by the readings in its percepts, and between them by its commands, as its
/// brain does.
#[derive(Debug, Clone, Default)]
pub struct PoseTracker {
    odometry: DeadReckoning,
    localisation: Localisation,
}

impl Hashed for PoseTracker {
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            odometry,
            localisation,
        } = self;
        localisation.add_to(hash);
        let Motion {
            speed_m_s,
            turn_rate_rad_s,
        } = odometry.command();
        [speed_m_s, turn_rate_rad_s].add_to(hash);
    }
}

impl PoseTracker {
    /// Takes a percept; one that is not later than the last one is ignored.
    pub fn observe(&mut self, percept: &Percept, body: &Body) {
        let Some(elapsed_s) = self.odometry.elapsed_s(percept.time_s, body.period_s) else {
            return;
        };
        let moved = self.odometry.reckon(percept, body, elapsed_s);
        let likely = self.odometry.likely(percept, body, &moved);
        self.localisation.step(percept, body, &likely);
    }

    /// Takes the motion that is commanded from the last percept on.
    pub fn command(&mut self, motion: Motion) {
        self.odometry.record_command(motion);
    }

    /// The pose some time after the last percept, if the command is in force until then; `None` while it
    /// is unknown.
    #[must_use]
    pub fn pose_after(&self, elapsed_s: f64, body: &Body) -> Option<Pose> {
        if elapsed_s <= 0.0 {
            return self.localisation.pose();
        }
        let ahead = self.odometry.ahead(elapsed_s, body);
        self.localisation.pose_after(&ahead, body)
    }

    /// The estimated speed, in m/s; negative in reverse.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.localisation.speed_m_s()
    }
}
