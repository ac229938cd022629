//! Whether a controller declares a lane clear, or gives it up.

use super::picture::LanePicture;
use super::plan::Plan;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{Act, ActKind};

/// A lane is given up when no goal has lowered the risk for this time, in seconds: robots out of range
/// may come back.
const PATIENCE_S: f64 = 60.0;

/// What a controller states about a lane. It states it once.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct LaneStatement {
    /// Whether it declares the lane clear; otherwise it gives it up.
    pub is_clear: bool,
    /// The probability that at least one mine is left, at that time.
    pub risk: f64,
    /// That time, on its clock.
    pub at_s: f64,
}

impl LaneStatement {
    /// The act by which a controller states it.
    pub(crate) fn act(&self) -> Act {
        let kind = if self.is_clear {
            ActKind::DeclareClear
        } else {
            ActKind::GiveUp
        };
        let at = Point::default();
        Act { kind, at }
    }
}

/// The decision on a lane.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(crate) struct Decision {
    pub(crate) statement: Option<LaneStatement>,
    /// Since when no goal lowers the risk.
    hopeless_since_s: Option<f64>,
}

impl Decision {
    /// Declares the lane clear when the risk is low and all marks that robots report have been
    /// received; gives it up when no robot in range can lower the risk.
    pub(crate) fn decide(&mut self, picture: &LanePicture, plan: &Plan, now_s: f64) {
        let is_hopeless = self.is_hopeless(plan, now_s);
        let is_clear =
            plan.risk < picture.clearance().declare_below && picture.missing_marks() == 0;
        if is_clear || is_hopeless {
            self.state(is_clear, plan.risk, now_s);
        }
    }

    /// Gives the lane up, as a person orders it.
    pub(crate) fn give_up(&mut self, plan: &Plan, now_s: f64) {
        self.state(false, plan.risk, now_s);
    }

    fn state(&mut self, is_clear: bool, risk: f64, at_s: f64) {
        let statement = LaneStatement {
            is_clear,
            risk,
            at_s,
        };
        self.statement.get_or_insert(statement);
    }

    /// Whether no goal has lowered the risk for long.
    fn is_hopeless(&mut self, plan: &Plan, now_s: f64) -> bool {
        self.hopeless_since_s = if plan.is_possible {
            None
        } else {
            self.hopeless_since_s.or(Some(now_s))
        };
        self.hopeless_since_s
            .is_some_and(|since_s| now_s >= since_s + PATIENCE_S)
    }
}
