//! Steps and seconds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How time passes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClockSpec {
    /// Time of a step, in seconds.
    #[serde(default = "tenth")]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub step_s: f64,
    /// A run ends here, in seconds; a search that has not found all by then has failed.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub cap_s: f64,
}

fn tenth() -> f64 {
    0.1
}
