//! Goals: places that robots are to visit or search.

pub(crate) mod kind;
pub(crate) mod placed;

use base::placement::Placement;
use brain::Work;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of goal, and the number of these goals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GoalSpec {
    /// Number of goals of this kind.
    #[schemars(range(max = 10_000))]
    pub count: u32,
    /// Where the goals are. At fixed positions they are the goals of a `navigate` behaviour with the same list of
    /// waypoints.
    #[serde(default)]
    pub placement: Placement,
    /// What is to be done there.
    #[serde(default = "visit")]
    pub work: Work,
    /// Value of serving one of them, relative to other goals.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
    /// A goal is served by a robot within this distance, in metres; of a search, the radius of the area.
    #[serde(default = "one")]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub within_m: f64,
    /// Time that a robot has to be there to serve it, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub service_s: f64,
    /// Time from the arrival of a goal until it expires, in seconds. Without it, it never does.
    #[schemars(range(min = 0.001, max = 1e7))]
    pub deadline_s: Option<f64>,
    /// The capability that a robot needs to serve it: one of those that a kind of robots has.
    pub requires: Option<String>,
    /// Time at which the first goal arrives, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub arrive_s: f64,
    /// Time from the arrival of one goal to that of the next, in seconds; at 0 all arrive together.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e7))]
    pub every_s: f64,
    /// The kind of controllers that own them: the first goal is issued to its first controller, and so on, starting
    /// again after the last. If it does not work, the next one that works gets the goal, of another kind if none of its
    /// own works. May be omitted if there is only one kind.
    pub owner: Option<String>,
}

fn visit() -> Work {
    Work::Visit
}

fn one() -> f64 {
    1.0
}
