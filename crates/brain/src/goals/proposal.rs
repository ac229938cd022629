//! The proposal of a behaviour.

use crate::io::command::Motion;
use crate::io::goal_id::{GoalId, GoalPlace};
use base::geometry::Point;
use base::hashed::Hashed;

/// What an active behaviour proposes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Proposal {
    /// A motion for this step.
    Motion(Motion),
    /// A place to be.
    Destination(Destination),
}

/// A place to be; the [navigator](crate::navigation::navigator) finds the path for all behaviours.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Destination {
    /// The goal of being there.
    pub(crate) id: GoalId,
    /// In world coordinates.
    pub(crate) at: Point,
    /// It is reached within this distance.
    pub(crate) tolerance_m: f64,
    /// It is reached only if the standard deviation of the position is at most this; infinite without a
    /// limit.
    pub(crate) max_deviation_m: f64,
    /// Whether it is a place of work on an item that may destroy the robot: the robot goes as near as `tolerance_m` needs,
    /// and no nearer than it is safe.
    #[hashed(skip)]
    pub(crate) is_at_hazard: bool,
    pub(crate) max_speed_m_s: f64,
    /// Value of being there, relative to other destinations.
    pub(crate) value: f64,
}

/// A robot knows that it is within a distance of a place only if the standard deviation of its position
/// is at most this fraction of the distance: in the plane, it then is within it of where it believes to
/// be in 86 of 100 cases, 1 - exp(-2^2 / 2).
const MAX_DEVIATION: f64 = 0.5;

/// It drives nearer by this number of standard deviations, but at most to this fraction of the distance:
/// where it seems to be at the very edge, it is outside in half of the cases.
const MARGIN_DEVIATIONS: f64 = 2.0;
const MIN_WITHIN: f64 = 0.6;

/// The largest standard deviation of a position with which a robot knows that it is within a distance
/// of a place.
#[must_use]
pub fn max_deviation_m(within_m: f64) -> f64 {
    MAX_DEVIATION * within_m
}

/// The distance at which a robot whose position has a standard deviation is within a distance of a
/// place.
pub(crate) fn within_m(tolerance_m: f64, deviation_m: f64) -> f64 {
    (tolerance_m - MARGIN_DEVIATIONS * deviation_m).max(MIN_WITHIN * tolerance_m)
}

impl Destination {
    /// The same at another place.
    pub(crate) fn moved_to(&self, at: Point) -> Self {
        Self { at, ..*self }
    }

    /// Whether a robot at a position with this standard deviation is there.
    pub(crate) fn is_reached(&self, at: Point, deviation_m: f64) -> bool {
        let within_m = if self.max_deviation_m.is_finite() {
            within_m(self.tolerance_m, deviation_m)
        } else {
            self.tolerance_m
        };
        deviation_m <= self.max_deviation_m && at.to(self.at).length() <= within_m
    }

    /// Whether it seems to be there, but does not know its position well enough.
    pub(crate) fn is_uncertain(&self, at: Point, deviation_m: f64) -> bool {
        deviation_m > self.max_deviation_m && at.to(self.at).length() <= self.tolerance_m
    }

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
