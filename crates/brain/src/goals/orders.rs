//! The goals that a person assigns to a robot.
//!
//! A goal with an [order](About::Order) is visited in the order of assignment. One that turns out to
//! be impossible is tried again after all others.

use super::fitness::{Fitness, Pursuit, Step, Verdict};
use super::proposal::Destination;
use crate::io::agent_id::AgentId;
use crate::io::goal_id::{GoalId, GoalPlace, issuer_of};
use crate::io::message::{About, OrderAction};
use crate::io::percept::ReceivedMessage;
use crate::io::reason::Reason;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Maximum number of goals, waypoints included; complete ones count until they are withdrawn.
const MAX_GOALS: usize = 10_000;

/// Larger coordinates in metres are invalid.
const MAX_COORDINATE_M: f64 = 1e7;

/// A goal that a person has assigned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
pub struct AssignedGoal {
    /// Its id.
    pub id: GoalId,
    /// Its position in the world.
    pub at: Point,
    /// Its state.
    pub verdict: OrderVerdict,
    /// Why it is impossible; `None` if it is not.
    pub reason: Option<Reason>,
}

/// The state of a goal that a person has assigned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum OrderVerdict {
    /// It waits for its turn.
    Pending,
    /// The robot comes nearer.
    Approaching,
    /// The robot has not come nearer for some time.
    Receding,
    /// The robot has been there.
    Complete,
    /// The robot has tried for too long. It tries again after all other goals.
    Impossible,
}

/// The goals that a person has assigned to a robot, in the order of assignment.
#[derive(Debug, Clone)]
pub(crate) struct Orders {
    goals: Vec<Order>,
    /// The goal that was pursued in the last step.
    pursued: Option<GoalId>,
}

#[derive(Debug, Clone, Copy)]
struct Order {
    goal: GoalPlace,
    verdict: OrderVerdict,
    fitness: Fitness,
    /// Number of times that it was impossible, and the distance and the reason when it last was.
    failures: u32,
    failed_m: f64,
    reason: Reason,
}

/// The order in a message, if it is valid and comes from the operator.
pub(crate) fn order_of(received: &ReceivedMessage) -> Option<(GoalPlace, OrderAction)> {
    let About::Order { goal, at, action } = received.message.about else {
        return None;
    };
    let is_own = received.from == AgentId::OPERATOR && goal.issuer == received.from.into();
    let is_valid = (0.0..=1.0).contains(&received.message.confidence)
        && (0.0..f64::INFINITY).contains(&received.age_s)
        && at.x.abs() <= MAX_COORDINATE_M
        && at.y.abs() <= MAX_COORDINATE_M;
    (is_own && is_valid).then_some((GoalPlace { id: goal, at }, action))
}

impl Orders {
    /// The waypoints of a list, of which the first have been visited, before any order.
    pub(crate) fn of_waypoints(waypoints: &[Point], visited: usize) -> Self {
        let issuer = issuer_of(waypoints);
        let goals = (0_u32..).zip(waypoints).map(|(number, at)| {
            let id = GoalId { issuer, number };
            Order::new(GoalPlace { id, at: *at })
        });
        let mut goals: Vec<Order> = goals.collect();
        for order in goals.iter_mut().take(visited) {
            order.verdict = OrderVerdict::Complete;
        }
        Self {
            goals,
            pursued: None,
        }
    }

    /// Executes an order; an assignment beyond the maximum number is refused.
    pub(crate) fn obey(&mut self, goal: GoalPlace, action: OrderAction) {
        let known = self.goals.iter().position(|order| order.goal.id == goal.id);
        match (action, known) {
            (OrderAction::Withdraw, Some(index)) => {
                self.goals.remove(index);
            }
            (OrderAction::Assign, Some(index)) if self.goals[index].goal != goal => {
                self.goals[index] = Order::new(goal);
            }
            (OrderAction::Assign, None) if self.goals.len() < MAX_GOALS => {
                self.goals.push(Order::new(goal));
            }
            // Repeated, unknown, or too many.
            _ => {}
        }
    }

    /// The goal to visit next.
    pub(crate) fn next(&self) -> Option<GoalPlace> {
        Some(self.goals[self.next_index()?].goal)
    }

    fn next_index(&self) -> Option<usize> {
        let numbered = self.goals.iter().enumerate();
        let left = numbered.filter(|(_, order)| order.verdict != OrderVerdict::Complete);
        let next = left.min_by_key(|(_, order)| order.failures);
        next.map(|(index, _)| index)
    }

    /// Judges the goal to visit next in a step; `destination` is one without goal and place.
    pub(crate) fn judge(&mut self, destination: &Destination, step: &Step) {
        let Some(index) = self.next_index() else {
            return;
        };
        let order = &mut self.goals[index];
        let previous = self.pursued.replace(order.goal.id);
        if previous != Some(order.goal.id) {
            order.fitness = Fitness::default();
        }
        order.judge(destination, step);
    }

    /// All goals.
    pub(crate) fn assigned(&self) -> Vec<AssignedGoal> {
        let next = self.next().map(|goal| goal.id);
        let pursued = self.pursued.filter(|pursued| next == Some(*pursued));
        let goals = self.goals.iter();
        let assigned = goals.map(|order| {
            let verdict = if pursued == Some(order.goal.id) {
                order.verdict
            } else {
                order.verdict_while_waiting()
            };
            let is_impossible = verdict == OrderVerdict::Impossible;
            AssignedGoal {
                id: order.goal.id,
                at: order.goal.at,
                verdict,
                reason: is_impossible.then_some(order.reason),
            }
        });
        assigned.collect()
    }
}

impl Order {
    fn new(goal: GoalPlace) -> Self {
        Self {
            goal,
            verdict: OrderVerdict::Pending,
            fitness: Fitness::default(),
            failures: 0,
            failed_m: f64::INFINITY,
            reason: Reason::Unreachable,
        }
    }

    fn judge(&mut self, destination: &Destination, step: &Step) {
        let GoalPlace { id, at } = self.goal;
        let distance_m = step.at.to(at).length();
        let step = Step {
            pursued: Some(Pursuit {
                goal: self.goal,
                remaining_m: distance_m,
                added_m: 0.0,
            }),
            ..*step
        };
        let destination = Destination {
            id,
            at,
            ..*destination
        };
        let is_no_nearer = distance_m > self.failed_m - step.min_progress_m();
        self.verdict = match self.fitness.update(&destination, &step) {
            Verdict::Complete => OrderVerdict::Complete,
            Verdict::Impossible => {
                (self.failures, self.failed_m) = (self.failures.saturating_add(1), distance_m);
                self.reason = self.fitness.reason(&destination, &step);
                self.fitness = Fitness::default();
                OrderVerdict::Impossible
            }
            // Trying again does not make it possible; coming nearer does.
            _ if self.failures > 0 && is_no_nearer => OrderVerdict::Impossible,
            Verdict::Approaching => OrderVerdict::Approaching,
            Verdict::Receding => OrderVerdict::Receding,
        };
    }

    fn verdict_while_waiting(&self) -> OrderVerdict {
        match self.verdict {
            OrderVerdict::Complete => OrderVerdict::Complete,
            _ if self.failures > 0 => OrderVerdict::Impossible,
            _ => OrderVerdict::Pending,
        }
    }
}
