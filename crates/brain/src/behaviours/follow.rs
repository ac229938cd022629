//! Following another robot.

use super::goal_behaviour::GoalBehaviour;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Follows another robot of its kind at a distance, as long as it detects it or receives its
/// position. The leader of all has nothing to do here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Follow {
    /// Index of the robot to follow, within the kind. Without it, the one before it, so that all
    /// robots form a column behind the first.
    pub robot: Option<u32>,
    /// Distance to keep, between the footprints, in metres.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub distance_m: f64,
    /// Value of following, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Follow {
    fn default() -> Self {
        Self {
            robot: None,
            distance_m: 1.0,
            value: 1.0,
        }
    }
}

/// Minimum motion of the leader that changes the destination, in metres. Each change is broadcast
/// and requires a new plan.
const SAME_M: f64 = 0.3;

/// [`Follow`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    robot: Option<u32>,
    apart_m: f64,
    destination: Destination,
}

impl Ready {
    pub(super) fn new(spec: &Follow, body: &Body) -> Self {
        Self {
            robot: spec.robot,
            apart_m: spec.distance_m + 2.0 * body.radius_m,
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: 0.1,
                max_deviation_m: f64::INFINITY,
                is_at_hazard: false,
                max_speed_m_s: body.max_speed_m_s,
                value: spec.value,
            },
        }
    }

    fn leader(&self, own: AgentId) -> Option<AgentId> {
        let index = match self.robot {
            Some(robot) => robot,
            None => own.index.checked_sub(1)?,
        };
        (index != own.index).then_some(AgentId { index, ..own })
    }
}

impl GoalBehaviour for Ready {
    /// The goal, which moves with the leader.
    type Progress = GoalPlace;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, to: &mut Option<Box<GoalPlace>>, situation: &Situation) -> Option<Proposal> {
        let beliefs = situation.beliefs?;
        let pose = beliefs.pose()?;
        let leader = self.leader(situation.percept.id)?;
        let at: Point = situation.position_of(leader)?;
        let way = at.to(pose.at);
        let away_m = way.length();
        if away_m <= self.apart_m {
            return Some(Motion::default().into());
        }
        let beside = at.plus(way.times(self.apart_m / away_m));
        let to = to.get_or_insert_with(|| Box::new(situation.new_goal(beside)));
        if to.at.to(beside).length() >= SAME_M {
            to.at = beside;
        }
        Some(self.drive_to(**to))
    }
}
