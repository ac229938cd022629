//! The life of a goal: at any time, it is in exactly one state.

use super::agent::Agent;
use super::controller::ControllerAgent;
use super::state::State;
use crate::bodies::body_state::Status;
use crate::judge::goal_moment::is_late;
use crate::judge::goal_outcome::GoalBalance;
use crate::judge::goal_tally::GoalRecord;
use crate::scenario::Scenario;
use brain::behaviours::BehaviourSpec;
use brain::{About, AgentId, ContractMessage, GoalId, Issuer, issuer_of};
use std::collections::{BTreeMap, BTreeSet};

/// Where a goal is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GoalStatus {
    /// It has not arrived.
    Pending,
    /// The operator is to issue it, or to issue it again; without controllers, no robot drives there.
    Waiting,
    /// A controller owns it.
    Owned,
    /// A robot drives there.
    Awarded,
    /// A robot is there, and has not stayed as long as its service takes.
    InService,
    /// A robot has served it.
    Served,
    /// Its deadline has passed.
    Expired,
    /// A controller has reported why it cannot be served.
    Reported,
    /// No working agent knows it.
    Unknown,
}

impl GoalStatus {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pending => "pending",
            Self::Waiting => "waiting",
            Self::Owned => "owned",
            Self::Awarded => "awarded",
            Self::InService => "in_service",
            Self::Served => "served",
            Self::Expired => "expired",
            Self::Reported => "reported",
            Self::Unknown => "unknown",
        }
    }
}

/// What the working agents of a run know of its goals.
struct Known {
    /// The robots that hold leases of goals, or report that they have served them.
    assignees: BTreeMap<GoalId, usize>,
    /// The goals of which robots are to report that they serve them no longer.
    returned: BTreeSet<GoalId>,
    /// The lists of waypoints that robots visit by themselves.
    lists: BTreeSet<Issuer>,
    has_robots: bool,
}

impl State {
    /// The state of each goal, in the order of their kinds and indices.
    #[must_use]
    pub fn goal_statuses(&self, scenario: &Scenario) -> Vec<GoalStatus> {
        let known = self.known_to_robots(scenario);
        let goals = 0..self.goals.all.len();
        goals
            .map(|goal| self.goal_status(scenario, &known, goal))
            .collect()
    }

    /// How many goals are in which states.
    pub(super) fn goal_balance(&self, scenario: &Scenario) -> GoalBalance {
        let mut balance = GoalBalance::default();
        for status in self.goal_statuses(scenario) {
            let count = match status {
                GoalStatus::Pending => continue,
                GoalStatus::Waiting
                | GoalStatus::Owned
                | GoalStatus::Awarded
                | GoalStatus::InService => &mut balance.open,
                GoalStatus::Reported => &mut balance.reported,
                GoalStatus::Unknown => &mut balance.unknown,
                GoalStatus::Served | GoalStatus::Expired => &mut balance.ended,
            };
            *count += 1;
        }
        balance
    }

    fn goal_status(&self, scenario: &Scenario, known: &Known, number: usize) -> GoalStatus {
        let goal = &self.goals.all[number];
        let record = self
            .tally
            .goals
            .as_ref()
            .map(|tally| &tally.records[number]);
        let Some((record, issued_at)) = record.and_then(|record| Some((record, record.issued_at?)))
        else {
            return GoalStatus::Pending;
        };
        let deadline = scenario.goals[usize::from(goal.kind)].deadline_steps;
        if record.served.is_some() {
            GoalStatus::Served
        } else if is_late(deadline, issued_at, self.tick) {
            GoalStatus::Expired
        } else if let Some(robot) = self.robot_at(known, number) {
            self.status_with(robot, number)
        } else {
            self.status_without_robot(scenario, known, number)
        }
    }

    /// The robot that holds the lease of a goal, or drives there by itself.
    fn robot_at(&self, known: &Known, number: usize) -> Option<usize> {
        let id = self.goals.all[number].id;
        let assignee = known.assignees.get(&id).copied();
        let is_visited = known.lists.contains(&id.issuer);
        assignee.or_else(|| {
            let journeys = self.tally.goals.as_ref().filter(|_| is_visited)?;
            let journeys = journeys.journeys.iter();
            let mut robots = journeys.zip(&self.body_states).enumerate();
            let (robot, _) = robots.find(|(_, (journey, body_state))| {
                journey.goal == Some(number) && body_state.status == Status::Active
            })?;
            Some(robot)
        })
    }

    fn status_with(&self, robot: usize, number: usize) -> GoalStatus {
        let tally = self.tally.goals.as_ref();
        if tally.is_some_and(|tally| tally.is_in_service(robot, number)) {
            GoalStatus::InService
        } else {
            GoalStatus::Awarded
        }
    }

    fn status_without_robot(
        &self,
        scenario: &Scenario,
        known: &Known,
        number: usize,
    ) -> GoalStatus {
        let id = self.goals.all[number].id;
        let record = self.goal_record(number);
        let is_owned = self.knowing_controller(id, record.issued_to).is_some();
        let has_owners = scenario.first_owner(&self.goals.all[number]).is_some();
        let is_of_operator = self.goals.is_waiting(number) || record.issued_to.is_none();
        let is_visited = known.lists.contains(&id.issuer) || !has_owners && known.has_robots;
        let is_returned = record.returned.is_some() || known.returned.contains(&id);
        if record.unserved.is_some() && (is_owned || is_of_operator) {
            GoalStatus::Reported
        } else if is_owned {
            GoalStatus::Owned
        } else if self.goals.is_waiting(number) || is_visited {
            GoalStatus::Waiting
        } else if is_returned || record.is_done_in_error {
            GoalStatus::Reported
        } else {
            GoalStatus::Unknown
        }
    }

    pub(super) fn goal_record(&self, number: usize) -> GoalRecord {
        let tally = self.tally.goals.as_ref();
        tally.map_or_else(GoalRecord::default, |tally| tally.records[number])
    }

    /// The number of a working controller that knows a goal, or is about to receive it.
    pub(super) fn knowing_controller(
        &self,
        goal: GoalId,
        issued_to: Option<AgentId>,
    ) -> Option<usize> {
        self.controllers.iter().position(|agent| {
            agent.participant.is_working(&self.body_states) && knows(agent, goal, issued_to)
        })
    }

    /// Whether one of some controllers works and knows a goal.
    pub(super) fn is_known_to(&self, controllers: &[usize], goal: GoalId) -> bool {
        controllers.iter().any(|number| {
            let agent = &self.controllers[*number];
            let id = agent.participant.id;
            agent.participant.is_working(&self.body_states) && knows(agent, goal, Some(id))
        })
    }

    /// The robots that work, with their numbers.
    pub(super) fn working_robots(&self) -> impl Iterator<Item = (usize, &Agent)> {
        let robots = self.agents.iter().enumerate();
        robots.filter(|(robot, _)| self.body_states[*robot].status == Status::Active)
    }

    fn known_to_robots(&self, scenario: &Scenario) -> Known {
        let mut known = Known {
            assignees: BTreeMap::new(),
            lists: BTreeSet::new(),
            returned: BTreeSet::new(),
            has_robots: false,
        };
        let mut kinds = BTreeSet::new();
        for (robot, agent) in self.working_robots() {
            known.has_robots = true;
            kinds.insert(self.ids[robot].kind);
            let served = agent.brain.served_goals();
            let served = served.iter().map(|goal| goal.task.id);
            let finished = agent.brain.finished_goals();
            let assigned = finished.chain(served).map(|goal| (goal, robot));
            known.assignees.extend(assigned);
            known.returned.extend(agent.brain.returned_goals());
        }
        for kind in kinds {
            let spec = scenario.kinds[usize::from(kind)].brain.spec();
            known
                .lists
                .extend(spec.behaviours.iter().filter_map(visited));
        }
        known
    }
}

/// The list of waypoints that a behaviour visits, if it visits any.
fn visited(behaviour: &BehaviourSpec) -> Option<Issuer> {
    match behaviour {
        BehaviourSpec::Navigate(navigate) => Some(issuer_of(&navigate.waypoints_m)),
        _ => None,
    }
}

/// Whether a controller knows a goal, or is about to receive it.
fn knows(agent: &ControllerAgent, goal: GoalId, issued_to: Option<AgentId>) -> bool {
    let is_issued = || {
        let mut inbox = agent.participant.inbox.entries.iter();
        inbox.any(|late| match late.what.message.about {
            About::Contract(ContractMessage::Issue(task)) => task.id == goal,
            _ => false,
        })
    };
    // What a program elsewhere knows is not known here: it has what was issued to it.
    let is_elsewhere = agent.is_elsewhere && issued_to == Some(agent.participant.id);
    is_elsewhere || agent.controller.knows(goal) || is_issued()
}
