//! What a robot believes and wants, for whoever looks at it: pages, tests, people.

use crate::beliefs::Beliefs;
use crate::beliefs::pose::Pose;
use crate::body::RobotId;
use crate::goals::precedence::{likely, time_s};
use crate::goals::{Goal, Verdict};
use crate::mind::{Mind, Wants};
use crate::reach::Reach;
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a mind believes and wants at one moment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Thoughts {
    /// Where it believes itself to be, once it knows.
    pub pose: Option<Pose>,
    /// Items that it believes in, in the order in which it came to.
    pub items: Vec<BelievedItem>,
    /// Robots, and what else moves, nearby.
    pub robots: Vec<BelievedRobot>,
    /// What it wants, by precedence.
    pub goals: Vec<Wanted>,
    /// What the places around it were worth; none if it took no way in its last step.
    pub reach: Option<Reach>,
}

/// An item, as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedItem {
    /// Place of its kind in [`Body::item_kinds`](crate::Body::item_kinds).
    pub kind: u16,
    /// Where in the world.
    pub at: Point,
    /// Standard deviation of that along each axis.
    pub deviation_m: f64,
    /// How surely it is there, 0 to 1.
    pub confidence: f64,
}

/// A robot, as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedRobot {
    /// Which, if it is known for one.
    pub id: Option<RobotId>,
    /// From the robot's front.
    pub at: Point,
    /// Over ground, along the robot's front and left.
    pub velocity_m_s: Point,
    /// Time since it was last seen.
    pub age_s: f64,
}

/// A goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Wanted {
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

impl Thoughts {
    pub(crate) fn of(mind: &Mind) -> Self {
        let Mind { beliefs, wants } = mind;
        let robots = beliefs.others.movers.iter().map(|mover| BelievedRobot {
            id: mover.id,
            at: mover.at,
            velocity_m_s: mover.velocity_m_s,
            age_s: mover.age_s,
        });
        let goals = wants.goals.goals.iter();
        let goals = goals.map(|goal| Wanted::of(goal, beliefs, wants));
        Self {
            pose: beliefs.pose(),
            items: beliefs.believed_items().collect(),
            robots: robots.collect(),
            goals: goals.collect(),
            reach: Reach::of(&wants.way),
        }
    }
}

impl Wanted {
    fn of(goal: &Goal, beliefs: &Beliefs, wants: &Wants) -> Self {
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
