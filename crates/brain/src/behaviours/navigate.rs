//! Visiting waypoints.

use super::errands::{Errands, Waypoints};
use super::goal_behaviour::GoalBehaviour;
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal, max_deviation_m};
use crate::io::body::Body;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::situation::Situation;
use alloc::boxed::Box;
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Visits waypoints one after the other, around known obstacles; then it has nothing more to do. It
/// needs a position and a heading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Navigate {
    /// The waypoints, in metres.
    #[schemars(length(max = 10_000))]
    pub waypoints_m: Vec<Point>,
    /// Which robot visits which waypoints.
    pub assignment: Assignment,
    /// A waypoint within this distance is reached, in metres, if the standard deviation of the believed
    /// position is at most half of it.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// Value of being at the next waypoint, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

/// Which robot visits which waypoints.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Assignment {
    /// Every robot visits all of them.
    #[default]
    All,
    /// Each robot visits one: the first of its kind the first, and so on, starting again if there
    /// are fewer waypoints than robots.
    OneEach,
    /// The team visits all of them, each by the robot that gets there first: robots report by radio
    /// where they go and have been, and others visit what one cannot reach.
    Shared,
}

impl Navigate {
    /// Whether robots share the waypoints by messages.
    #[must_use]
    pub fn is_shared_by_team(&self) -> bool {
        self.assignment == Assignment::Shared
    }
}

impl Default for Navigate {
    fn default() -> Self {
        Self {
            waypoints_m: Vec::new(),
            assignment: Assignment::default(),
            within_m: 0.5,
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Navigate`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    assignment: Assignment,
    waypoints: Waypoints,
    destination: Destination,
}

impl Ready {
    pub(super) fn new(spec: &Navigate, body: &Body) -> Self {
        Self {
            assignment: spec.assignment,
            waypoints: Waypoints::new(&spec.waypoints_m),
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: spec.within_m,
                max_deviation_m: max_deviation_m(spec.within_m),
                is_at_hazard: false,
                max_speed_m_s: spec.speed_m_s.unwrap_or(body.max_speed_m_s),
                value: spec.value,
            },
        }
    }

    /// The waypoints of a robot, the next one last.
    fn errands(&self, situation: &Situation) -> Errands {
        let count = self.waypoints.count();
        Errands::new(match self.assignment {
            Assignment::All | Assignment::Shared => (0..count).rev().collect(),
            Assignment::OneEach => {
                let own = situation.percept.id.index.checked_rem(count);
                own.into_iter().collect()
            }
        })
    }

    fn next(&self, errands: &mut Errands, at: Point, situation: &Situation) -> Option<GoalPlace> {
        let waypoints = &self.waypoints;
        match self.assignment {
            Assignment::All | Assignment::OneEach => errands.next(waypoints),
            Assignment::Shared => {
                let mates = situation.peers?;
                errands.next_of_team(waypoints, (situation.percept.id, at), mates)
            }
        }
    }
}

impl GoalBehaviour for Ready {
    /// The remaining waypoints.
    type Progress = Errands;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, errands: &mut Option<Box<Errands>>, situation: &Situation) -> Option<Proposal> {
        let pose = situation.beliefs?.pose()?;
        let errands = errands.get_or_insert_with(|| Box::new(self.errands(situation)));
        let mut to = self.next(errands, pose.at, situation)?;
        let there = self.destination.moved_to(to.at);
        if there.is_reached(pose.at, pose.deviation_m) {
            errands.pop();
            to = self.next(errands, pose.at, situation)?;
        }
        Some(self.drive_to(to))
    }

    /// An unreachable waypoint is tried again after all others.
    fn judged(&self, errands: &mut Errands, verdict: Verdict) {
        if verdict == Verdict::Impossible {
            errands.decline();
        }
    }
}
