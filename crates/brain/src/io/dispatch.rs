//! Messages about the goals that controllers own and award to robots.

use super::goal_id::GoalId;
use base::hash::Hash;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message about a goal that a controller owns or awards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Dispatch {
    /// A goal that its receiver is to own from now on. It is accepted only from the operator.
    Issue(Task),
}

impl Hashed for Dispatch {
    fn add_to(&self, hash: &mut Hash) {
        match self {
            Self::Issue(task) => (0_u8, *task).add_to(hash),
        }
    }
}

/// A goal as it is described in messages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its id.
    pub id: GoalId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
    /// A robot is there within this distance; of a search, the radius of the area.
    pub radius_m: f32,
    /// Value of serving it, relative to other goals.
    pub value: f32,
    /// Time that a robot spends there.
    pub service_s: f32,
    /// Time from sending until its deadline; without one, `f32::MAX`.
    pub due_s: f32,
    /// What is to be done there.
    pub work: Work,
    /// Number of the capability that a robot needs for it, as in
    /// [`Body::capabilities`](crate::Body::capabilities); 0 if it needs none.
    pub capability: u8,
}

base::hashed!(Task {
    id,
    at_m,
    radius_m,
    value,
    service_s,
    due_s,
    work,
    capability
});

/// What a goal consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// To be there for the time of service.
    Visit,
    /// To search the area around it.
    Search,
}

base::hashed!(enum Work);
