//! Holding a position.

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

/// Stays where it is, or at a given position, and returns if something moves it away.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct HoldPosition {
    /// The position, in metres. Without it, where the robot is when this behaviour is first active.
    pub at_m: Option<Point>,
    /// The position is reached within this distance, in metres.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// Value of staying, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for HoldPosition {
    fn default() -> Self {
        Self {
            at_m: None,
            within_m: 1.0,
            value: 0.1,
        }
    }
}

/// [`HoldPosition`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    at: Option<Point>,
    destination: Destination,
}

impl Ready {
    pub(super) fn new(spec: &HoldPosition, body: &Body) -> Self {
        Self {
            at: spec.at_m,
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
}

impl GoalBehaviour for Ready {
    /// The position to hold.
    type Progress = GoalPlace;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, held: &mut Option<Box<GoalPlace>>, situation: &Situation) -> Option<Proposal> {
        let Some(pose) = situation.beliefs.and_then(Beliefs::pose) else {
            return Some(Motion::default().into());
        };
        let choose = || situation.new_goal(self.at.unwrap_or(pose.at));
        let to = **held.get_or_insert_with(|| Box::new(choose()));
        let is_there = pose.at.to(to.at).length() <= self.destination.tolerance_m;
        Some(if is_there {
            Motion::default().into()
        } else {
            self.drive_to(to)
        })
    }
}
