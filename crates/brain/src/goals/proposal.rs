//! The proposal of a behaviour.

use crate::io::command::Motion;
use crate::io::goal_id::{GoalId, GoalPlace};
use base::geometry::Point;

/// What an active behaviour proposes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Proposal {
    /// A motion for this step.
    Motion(Motion),
    /// A place to be.
    Destination(Destination),
}

/// A place to be; the [navigator](crate::navigation::navigator) finds the path for all behaviours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Destination {
    /// The goal of being there.
    pub(crate) id: GoalId,
    /// In world coordinates.
    pub(crate) at: Point,
    /// It is reached within this distance.
    pub(crate) tolerance_m: f64,
    pub(crate) max_speed_m_s: f64,
    /// Value of being there, relative to other destinations.
    pub(crate) value: f64,
}

base::hashed!(Destination {
    id,
    at,
    tolerance_m,
    max_speed_m_s,
    value
});

impl Destination {
    /// The goal and its place. What is known of the path to a goal holds while both are the same.
    pub(crate) fn goal(&self) -> GoalPlace {
        GoalPlace {
            id: self.id,
            at: self.at,
        }
    }
}

impl From<Motion> for Proposal {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}
