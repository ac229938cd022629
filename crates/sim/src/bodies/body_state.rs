//! What changes of a body in a run, besides its pose.

use super::external::ExternalBody;
use super::kind::Kind;
use super::source::BodySource;
use brain::Motion;

/// The state of a body, besides its pose.
#[derive(Debug, Clone, Default)]
pub(crate) struct BodyState {
    pub(crate) speed_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
    /// Energy taken from the battery so far.
    pub(crate) energy_j: f64,
    pub(crate) distance_m: f64,
    /// It is stopped until this step, because of a collision.
    pub(crate) held_until: u64,
    pub(crate) collisions: u32,
    pub(crate) status: Status,
    pub(crate) source: BodySource,
    /// It touched something in the last step, or it has not moved freely since.
    pub(crate) is_touching: bool,
    /// Something stopped it in the last step.
    pub(crate) is_pressed: bool,
}

impl BodyState {
    /// Its speed and turn rate.
    pub(crate) fn motion(&self) -> Motion {
        Motion {
            speed_m_s: self.speed_m_s,
            turn_rate_rad_s: self.turn_rate_rad_s,
        }
    }

    pub(crate) fn is_external(&self) -> bool {
        matches!(self.source, BodySource::External(_))
    }

    /// What is known of it, if it is external.
    pub(crate) fn external(&self) -> Option<&ExternalBody> {
        match &self.source {
            BodySource::Simulated => None,
            BodySource::External(external) => Some(external),
        }
    }

    /// The same, to change it.
    pub(crate) fn external_mut(&mut self) -> Option<&mut ExternalBody> {
        match &mut self.source {
            BodySource::Simulated => None,
            BodySource::External(external) => Some(external),
        }
    }

    /// Remaining fraction of its battery, 0 to 1; `None` if it never runs empty.
    pub(crate) fn charge(&self, kind: &Kind) -> Option<f64> {
        let capacity_j = kind.battery?.capacity_j;
        let left = (1.0 - self.energy_j / capacity_j).max(0.0);
        capacity_j.is_finite().then_some(left)
    }
}

/// Whether a robot can still move.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Status {
    /// It can.
    #[default]
    Active,
    /// Its battery is empty.
    Empty,
    /// It has collided too often, or failed.
    Broken,
}
