//! Returning to base before the battery is empty.

use super::goal_behaviour::GoalBehaviour;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::perception::beliefs::Beliefs;
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Returns to base when the battery is low, and stays there until it is charged. Low is the given
/// fraction, or less than the way back may take, whichever comes first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct ReturnHome {
    /// The base, in metres. Without it, where the robot was first switched on.
    pub at_m: Option<Point>,
    /// Remaining fraction of the battery at which it returns in any case.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub min_charge: f64,
    /// It returns when the battery lasts for at most this multiple of the straight way.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub reserve_factor: f64,
    /// The base is reached within this distance, in metres.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// Value of being at the base then, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for ReturnHome {
    fn default() -> Self {
        Self {
            at_m: None,
            min_charge: 0.1,
            reserve_factor: 2.0,
            within_m: 1.0,
            value: 1000.0,
        }
    }
}

/// Increase of the charge since it was low that shows that the battery was charged, or misread; so
/// does a full battery.
const GAINED: f64 = 0.2;
const FULL: f64 = 0.95;

/// [`ReturnHome`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    spec: ReturnHome,
    destination: Destination,
}

impl Ready {
    pub(super) fn new(spec: &ReturnHome, body: &Body) -> Self {
        Self {
            spec: spec.clone(),
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: spec.within_m,
                max_deviation_m: f64::INFINITY,
                is_at_hazard: false,
                max_speed_m_s: body.max_speed_m_s,
                value: spec.value,
            },
        }
    }

    /// The minimum charge since the robot started to return, if it still has to.
    fn low_since(&self, low: Option<f64>, way_m: f64, beliefs: &Beliefs) -> Option<f64> {
        let left = beliefs.battery_charge()?;
        let way_s = way_m / self.destination.max_speed_m_s.max(1e-6);
        let is_low =
            left <= self.spec.min_charge || beliefs.battery_s() < self.spec.reserve_factor * way_s;
        let low = low.filter(|low| left < (low + GAINED).min(FULL));
        match low {
            Some(low) => Some(low.min(left)),
            None => is_low.then_some(left),
        }
    }
}

impl GoalBehaviour for Ready {
    /// The base, and the minimum charge since the robot started to return, if it did.
    type Progress = (GoalPlace, Option<f64>);

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(
        &self,
        progress: &mut Option<Box<(GoalPlace, Option<f64>)>>,
        situation: &Situation,
    ) -> Option<Proposal> {
        let beliefs = situation.beliefs?;
        let at = beliefs.pose()?.at;
        let base = || situation.new_goal(self.spec.at_m.unwrap_or(at));
        let begin = || Box::new((base(), None));
        let (to, low) = &mut **progress.get_or_insert_with(begin);
        let way_m = at.to(to.at).length();
        *low = self.low_since(*low, way_m, beliefs);
        low.map(|_| {
            if way_m <= self.spec.within_m {
                Motion::default().into()
            } else {
                self.drive_to(*to)
            }
        })
    }
}
