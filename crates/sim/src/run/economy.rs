//! What can be observed of goals and controllers. No agent knows any of it unless by message.

use super::goal_life::GoalStatus;
use super::participant::Place;
use super::state::State;
use crate::clock::seconds;
use crate::judge::goal_moment::is_late;
use crate::scenario::Scenario;
use base::geometry::Point;
use brain::{AgentId, GoalId, Reason, Task};
use economy::OwnedGoal;

/// A goal of a run; times are `None` for what has not happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Its id in messages.
    pub id: GoalId,
    /// Index of its kind in the scenario.
    pub kind: u8,
    /// Its index within the kind.
    pub index: u32,
    /// Its position.
    pub at: Point,
    /// When it arrived.
    pub issued_s: Option<f64>,
    /// When it was first awarded to a robot.
    pub awarded_s: Option<f64>,
    /// When a robot first drove there.
    pub pursued_s: Option<f64>,
    /// When the robot that served it set out for the last time.
    pub began_s: Option<f64>,
    /// When that robot arrived.
    pub arrived_s: Option<f64>,
    /// When it was served.
    pub served_s: Option<f64>,
    /// Time in which that robot stood under way.
    pub blocked_s: Option<f64>,
    /// The robot that served it; `None` also if it was removed.
    pub served_by: Option<AgentId>,
    /// Whether several robots served it.
    pub is_served_twice: bool,
    /// Whether its deadline is over and no robot served it.
    pub has_expired: bool,
    /// Why no robot can serve it, as a controller last reported; `None` if it was served.
    pub unserved: Option<Reason>,
    /// Where it is in its life.
    pub status: GoalStatus,
}

/// A controller of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// Its id: its kind is numbered after all kinds of robots.
    pub id: AgentId,
    /// Its position.
    pub at: Point,
    /// The robot that carries it.
    pub aboard: Option<AgentId>,
    /// Range of its radio.
    pub range_m: f64,
    /// Whether it sends and receives: it has not failed, and neither has the robot that carries it.
    pub is_working: bool,
    /// Number of goals that it has transferred to others of its kind.
    pub transfers: u32,
    /// Number of goals that it refused.
    pub refused: u32,
    /// The goals that it owns, as far as it knows.
    pub goals: Vec<OwnedGoal>,
    /// The goals that no controller owns, as it has reported: no majority votes for it.
    pub lost: Vec<Task>,
}

impl State {
    /// All goals, in the order of their kinds and indices.
    pub fn each_goal(&self, scenario: &Scenario) -> impl Iterator<Item = Goal> {
        let tally = self.tally.goals.iter();
        let records = tally.flat_map(|goals| &goals.records);
        let statuses = self.goal_statuses(scenario);
        let each = self.goals.all.iter().zip(records).zip(statuses);
        each.map(|((goal, record), status)| {
            let time_s = |at: Option<u64>| at.map(|at| seconds(at, scenario.step_s));
            let deadline_steps = scenario.goals[usize::from(goal.kind)].deadline_steps;
            let is_late = |issued_at| is_late(deadline_steps, issued_at, self.tick);
            let served = record.served.as_ref();
            let unserved = match status {
                GoalStatus::Unknown => None,
                GoalStatus::Reported => record.reason(),
                _ => record.unserved,
            };
            Goal {
                id: goal.id,
                kind: goal.kind,
                index: goal.index,
                at: goal.at,
                issued_s: time_s(record.issued_at),
                awarded_s: time_s(record.awarded_at),
                pursued_s: time_s(record.pursued_at),
                began_s: time_s(served.map(|served| served.began_at)),
                arrived_s: time_s(served.map(|served| served.arrived_at)),
                served_s: time_s(served.map(|served| served.at)),
                blocked_s: time_s(served.map(|served| served.blocked)),
                served_by: served.and_then(|served| served.by),
                is_served_twice: record.is_served_twice,
                unserved: unserved.filter(|_| served.is_none()),
                has_expired: served.is_none() && record.issued_at.is_some_and(is_late),
                status,
            }
        })
    }

    /// All controllers, in the order of their kinds and indices.
    pub fn each_controller(&self) -> impl Iterator<Item = Controller> {
        self.controllers.iter().map(|agent| {
            let participant = &agent.participant;
            let (at, aboard) = match participant.place {
                Place::Fixed(at, _) => (at, None),
                Place::Aboard(robot) => {
                    let robot = robot as usize;
                    (self.discs[robot].centre, Some(self.ids[robot]))
                }
            };
            Controller {
                id: participant.id,
                at,
                aboard,
                range_m: participant.radio.range_m,
                is_working: participant.is_working(&self.body_states),
                transfers: agent.controller.transfers(),
                refused: agent.controller.refused(),
                goals: agent.controller.goals().collect(),
                lost: agent.controller.lost().collect(),
            }
        })
    }
}
