//! What a robot believes and wants, for whoever looks at it: pages, tests, people.

use super::heading_options::HeadingOptions;
use crate::arbitration::goal_selection::{BeliefBrain, GoalSelection};
use crate::goals::precedence::{likely, time_s};
use crate::goals::{Goal, Verdict};
use crate::perception::beliefs::Beliefs;
use crate::perception::beliefs::pose::Pose;
use crate::perception::believed::{BelievedItem, BelievedRobot};
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a mind believes and wants at one moment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeliefState {
    /// Where it believes itself to be, once it knows.
    pub pose: Option<Pose>,
    /// Items that it believes in, in the order in which it came to.
    pub items: Vec<BelievedItem>,
    /// Robots, and what else moves, nearby.
    pub robots: Vec<BelievedRobot>,
    /// What it wants, by precedence.
    pub goals: Vec<GoalState>,
    /// What the places around it were worth; none if it took no way in its last step.
    pub reach: Option<HeadingOptions>,
}

/// A goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GoalState {
    /// Place of the behaviour that wants it in the brain's list.
    pub behaviour: u32,
    /// Where in the world.
    pub to: Point,
    /// Its utility now: value x likely / (1 + time / 10 s).
    pub precedence: f64,
    /// What it is worth to be there.
    pub value: f64,
    /// How likely the battery lasts for it, 0 to 1.
    pub likely: f64,
    /// Time that the straight way there takes.
    pub time_s: f64,
    /// Nearer than this it is there.
    pub within_m: f64,
    /// What has become of it.
    pub verdict: Verdict,
    /// The way left in the last step, and the least so far.
    pub left_m: f64,
    /// See `left_m`.
    pub best_m: f64,
    /// It has not come nearer for so long.
    pub stuck_s: f64,
    /// It counts as impossible for so long, so that others have their turn.
    pub rests_s: f64,
    /// Whether the robot goes there now.
    pub is_pursued: bool,
}

impl BeliefState {
    pub(crate) fn of(mind: &BeliefBrain) -> Self {
        let BeliefBrain { beliefs, wants } = mind;
        let robots = beliefs.others.movers.iter().map(|mover| BelievedRobot {
            id: mover.id,
            at: mover.at,
            velocity_m_s: mover.velocity_m_s,
            age_s: mover.age_s,
        });
        let goals = wants.goals.goals.iter();
        let goals = goals.map(|goal| GoalState::of(goal, beliefs, wants));
        Self {
            pose: beliefs.pose(),
            items: beliefs.believed_items().collect(),
            robots: robots.collect(),
            goals: goals.collect(),
            reach: HeadingOptions::of(&wants.way),
        }
    }
}

impl GoalState {
    fn of(goal: &Goal, beliefs: &Beliefs, wants: &GoalSelection) -> Self {
        let (aim, fitness) = (&goal.aim, &goal.fitness);
        let way_m = beliefs.pose().map(|pose| pose.at.to(aim.to).length());
        let time_s = time_s(way_m.unwrap_or_default(), aim);
        Self {
            behaviour: u32::try_from(goal.behaviour).unwrap_or(u32::MAX),
            to: aim.to,
            precedence: goal.precedence,
            value: aim.value,
            likely: likely(time_s, beliefs.battery_s()),
            time_s,
            within_m: aim.within_m,
            verdict: goal.verdict,
            left_m: fitness.last_m,
            best_m: fitness.best_m,
            stuck_s: fitness.since_s,
            rests_s: fitness.rests_s.max(0.0),
            is_pursued: wants.is_pursued(goal),
        }
    }
}
