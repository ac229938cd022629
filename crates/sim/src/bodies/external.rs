//! Where a body is that something outside of the simulation moves.

use base::hashed::Hashed;
use brain::{Body, Motion, Percept, Pose, PoseTracker};

/// A command counts as executed for this number of periods of the brain. A robot whose percepts end has
/// been stopped.
const MAX_PERIODS: f64 = 2.0;

/// The estimated motion of an external body.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct ExternalBody {
    tracker: PoseTracker,
    /// Time since its last percept.
    since_s: f64,
    /// Whether it is where something else is.
    pub(crate) is_in_contact: bool,
}

impl ExternalBody {
    /// Takes a percept.
    pub(crate) fn observe(&mut self, percept: &Percept, body: &Body) {
        self.tracker.observe(percept, body);
        self.since_s = 0.0;
    }

    /// Takes the motion that is commanded from the last percept on.
    pub(crate) fn command(&mut self, motion: Motion) {
        self.tracker.command(motion);
    }

    /// Lets time pass without a percept.
    pub(crate) fn wait(&mut self, elapsed_s: f64) {
        self.since_s += elapsed_s;
    }

    /// Its pose now, if known.
    pub(crate) fn pose(&self, body: &Body) -> Option<Pose> {
        let moving_s = self.since_s.min(MAX_PERIODS * body.period_s);
        self.tracker.pose_after(moving_s, body)
    }

    /// Its speed now, in m/s; negative in reverse.
    pub(crate) fn speed_m_s(&self, body: &Body) -> f64 {
        if self.since_s > MAX_PERIODS * body.period_s {
            0.0
        } else {
            self.tracker.speed_m_s()
        }
    }
}
