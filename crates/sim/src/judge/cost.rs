//! What robots have cost.

use crate::bodies::body_state::{BodyState, Status};

/// The total cost of some robots.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Cost {
    pub(crate) energy_j: f64,
    pub(crate) distance_m: f64,
    pub(crate) stopped: u32,
}

impl Cost {
    /// Adds the cost of other robots.
    pub(crate) fn and<'a>(self, body_states: impl Iterator<Item = &'a BodyState>) -> Self {
        body_states.fold(self, |all, body_state| Self {
            energy_j: all.energy_j + body_state.energy_j,
            distance_m: all.distance_m + body_state.distance_m,
            stopped: all.stopped + u32::from(body_state.status != Status::Active),
        })
    }
}
