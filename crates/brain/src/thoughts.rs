//! What a robot believes and wants, for whoever looks at it: pages, tests, people.

use crate::beliefs::pose::Pose;
use crate::body::RobotId;
use crate::goals::Verdict;
use crate::mind::Mind;
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
    /// Its utility now.
    pub precedence: f64,
    /// What has become of it.
    pub verdict: Verdict,
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
        let goals = wants.goals.goals.iter().map(|goal| Wanted {
            behaviour: u32::try_from(goal.behaviour).unwrap_or(u32::MAX),
            to: goal.aim.to,
            precedence: goal.precedence,
            verdict: goal.verdict,
        });
        Self {
            pose: beliefs.pose(),
            items: beliefs.believed_items().collect(),
            robots: robots.collect(),
            goals: goals.collect(),
        }
    }
}
