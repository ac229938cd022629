//! The beliefs and goals of a robot.

use super::heading_options::HeadingOptions;
use crate::arbitration::goal_selection::{BeliefBrain, GoalSelection};
use crate::goals::precedence::{reachable_probability, time_s};
use crate::goals::{Goal, Verdict};
use crate::io::reason::Reason;
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::pose::Pose;
use crate::perception::believed::{BelievedItem, BelievedRobot};
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The beliefs and goals of a robot at one moment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeliefState {
    /// Its believed pose, once it is known.
    pub pose: Option<Pose>,
    /// Believed items, in the order of their first observation.
    pub items: Vec<BelievedItem>,
    /// Robots and other moving things nearby.
    pub robots: Vec<BelievedRobot>,
    /// Its goals, by precedence.
    pub goals: Vec<GoalState>,
    /// The utility of the headings around it; none if it did not navigate in its last step.
    pub heading_options: Option<HeadingOptions>,
}

/// A goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GoalState {
    /// Index of its behaviour in the brain's list.
    pub behaviour: u32,
    /// Its position in the world.
    pub to: Point,
    /// Its current utility: value x `battery_probability` / (1 + time / 10 s).
    pub precedence: f64,
    /// Value of being there.
    pub value: f64,
    /// Probability that the battery lasts, 0 to 1.
    pub battery_probability: f64,
    /// Time for the straight way.
    pub time_s: f64,
    /// It is reached within this distance.
    pub within_m: f64,
    /// Its fitness verdict.
    pub verdict: Verdict,
    /// Why it is impossible; `None` if it is not.
    pub reason: Option<Reason>,
    /// Remaining path length in the last step, and the minimum so far.
    pub remaining_m: f64,
    /// See `remaining_m`.
    pub min_remaining_m: f64,
    /// Time without coming nearer.
    pub stuck_s: f64,
    /// Time for which it still counts as impossible, so that other goals are served.
    pub retry_s: f64,
    /// Whether the robot pursues it now.
    pub is_pursued: bool,
}

impl BeliefState {
    pub(crate) fn of(brain: &BeliefBrain) -> Self {
        let BeliefBrain {
            beliefs,
            messaging,
            selection,
        } = brain;
        let robots = beliefs.others.movers.iter().map(|mover| BelievedRobot {
            id: mover.id,
            at: mover.at,
            velocity_m_s: mover.velocity_m_s,
            age_s: mover.age_s,
        });
        let goals = selection.goals.list.iter();
        let goals = goals.map(|goal| GoalState::of(goal, beliefs, selection));
        Self {
            pose: beliefs.pose(),
            items: messaging.believed_items(beliefs),
            robots: robots.collect(),
            goals: goals.collect(),
            heading_options: HeadingOptions::of(&selection.navigator),
        }
    }
}

impl GoalState {
    fn of(goal: &Goal, beliefs: &Beliefs, selection: &GoalSelection) -> Self {
        let (destination, fitness) = (&goal.destination, &goal.fitness);
        let distance_m = beliefs
            .pose()
            .map(|pose| pose.at.to(destination.at).length());
        let time_s = time_s(distance_m.unwrap_or_default(), destination);
        Self {
            behaviour: u32::try_from(goal.behaviour).unwrap_or(u32::MAX),
            to: destination.at,
            precedence: goal.precedence,
            value: destination.value,
            battery_probability: reachable_probability(time_s, beliefs.battery_s()),
            time_s,
            within_m: destination.tolerance_m,
            verdict: goal.verdict,
            reason: goal.reason,
            remaining_m: fitness.last_m,
            min_remaining_m: fitness.min_m(),
            stuck_s: fitness.stuck_s,
            retry_s: goal.rest_s,
            is_pursued: selection.is_pursued(goal),
        }
    }
}
