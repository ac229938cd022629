//! A mined lane that controllers are to clear.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A mined lane that controllers are to clear: they send robots to search it, to interrogate what has been marked and
/// to neutralise mines, and state that it is clear, or give it up. They know nothing but what robots send. The
/// kinds of items that are targets make the lane unsafe until they are neutralised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClearanceSpec {
    /// The lower left and the upper right corner of the lane, in metres; by default those of the world.
    pub lane_m: Option<[[f64; 2]; 2]>,
    /// Number of items of each kind that the controllers expect in the lane, the mean of a Poisson distribution. By default
    /// the `count` of the kind. With a wrong number, what they state is wrong too.
    #[serde(default)]
    pub expected_count: BTreeMap<String, f64>,
    /// The lane is declared clear when the probability that at least one mine is left is below this.
    #[serde(default = "one_in_twenty")]
    #[schemars(range(min = 0.0001, max = 0.9999))]
    pub declare_below: f64,
    /// Marks are interrogated while the probability of a mine there is above this, and neutralised if it still is.
    #[serde(default = "one_in_fifty")]
    #[schemars(range(min = 0.0001, max = 0.9999))]
    pub interrogate_above: f64,
    /// A person ends the mission, from the start or from when this changes in a run: controllers that have stated
    /// nothing give the lane up, and state the risk.
    #[serde(default)]
    pub called_off: bool,
    /// Side of the cells for which the controllers compute the remaining risk, in metres.
    #[serde(default = "one")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub cell_m: f64,
    /// Side of the tiles that are searched as one goal, in metres.
    #[serde(default = "twenty")]
    #[schemars(range(min = 0.5, max = 10_000.0))]
    pub tile_m: f64,
    /// The ways to search a tile, such as a survey from the air and a search on the ground.
    pub searches: Vec<SkillSpec>,
    /// How robots interrogate marks; without it, none does.
    pub interrogate: Option<SkillSpec>,
    /// How robots neutralise marked items, with the tool of that name; without it, none does.
    pub neutralise: Option<SkillSpec>,
}

/// What robots need for goals of a kind.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SkillSpec {
    /// The capability that a robot needs; by default none.
    pub requires: Option<String>,
    /// Time for which the robot looks at the place, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub service_s: f64,
}

fn one_in_twenty() -> f64 {
    0.05
}

fn one_in_fifty() -> f64 {
    0.02
}

fn one() -> f64 {
    1.0
}

fn twenty() -> f64 {
    20.0
}
