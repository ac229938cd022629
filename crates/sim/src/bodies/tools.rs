//! Tools: what robots can do to items, besides detecting them.

use crate::schedule::steps_of;
use brain::ActKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tools of a robot. Without a tool, it cannot act so.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToolsSpec {
    /// Marks places, which only states that there may be an item.
    pub mark: Option<StatementSpec>,
    /// Confirms or rejects marks after a closer look, which only states whether there is an item.
    pub confirm: Option<StatementSpec>,
    /// Fences off items.
    pub isolate: Option<IsolateSpec>,
    /// Destroys items with charges.
    pub neutralise: Option<NeutraliseSpec>,
}

/// A tool for statements about a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StatementSpec {
    /// Maximum distance of the place from the centre of the robot, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub range_m: f64,
}

/// A tool that fences off items.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IsolateSpec {
    /// Maximum distance of the place from the centre of the robot, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub range_m: f64,
    /// Radius of the fence around the place that the robot chose, in metres: all items in it are isolated.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub reach_m: f64,
    /// Time for which the robot is stationary, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub duration_s: f64,
}

/// A tool that destroys items with charges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NeutraliseSpec {
    /// Maximum distance of the item from the centre of the robot, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub range_m: f64,
    /// Maximum distance of the item from the place that the robot chose, in metres. The nearest item is destroyed.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub reach_m: f64,
    /// Time for which the robot is stationary, in seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub duration_s: f64,
    /// Probability that a charge destroys the item.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub success_probability: f64,
    /// Number of charges of each robot at the start: each attempt takes one. They are part of `payload_kg`, which stays
    /// the same when they are used.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub charges: u32,
}

fn one() -> f64 {
    1.0
}

/// A tool, converted for runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tool {
    /// What its robot knows of it.
    pub(crate) known: brain::Tool,
    /// Steps for which the robot is stationary.
    pub(crate) duration_steps: u64,
    pub(crate) success_probability: f64,
}

impl ToolsSpec {
    /// Its tools, one for each kind of act, converted for steps of this length.
    pub(crate) fn ready(&self, step_s: f64) -> Vec<Tool> {
        let tool = |act, [range_m, reach_m, duration_s, success_probability]: [f64; 4]| Tool {
            known: brain::Tool {
                act,
                range_m,
                reach_m,
                duration_s,
            },
            duration_steps: steps_of(duration_s, step_s),
            success_probability,
        };
        let statements = [
            (ActKind::Mark, &self.mark),
            (ActKind::Confirm, &self.confirm),
            (ActKind::Reject, &self.confirm),
        ];
        let statements = statements.into_iter();
        let statements = statements
            .filter_map(|(act, of)| Some(tool(act, [of.as_ref()?.range_m, 0.0, 0.0, 1.0])));
        let isolate = self.isolate.iter().map(|of| {
            let numbers = [of.range_m, of.reach_m, of.duration_s, 1.0];
            tool(ActKind::Isolate, numbers)
        });
        let neutralise = self.neutralise.iter().map(|of| {
            let numbers = [
                of.range_m,
                of.reach_m,
                of.duration_s,
                of.success_probability,
            ];
            tool(ActKind::Neutralise, numbers)
        });
        statements.chain(isolate).chain(neutralise).collect()
    }
}
