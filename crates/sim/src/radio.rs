//! Who hears what, and when.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A radio that sends to every robot in range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RadioSpec {
    /// Who is nearer when it sends can hear it, in metres.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub range_m: f64,
    /// Probability that one receiver misses a message.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss: f64,
    /// Time from sending to hearing, in seconds; a message is heard in the next step at the soonest.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub delay_s: f64,
    /// It sends the first so many messages of a step, and hears at most so many in one.
    #[serde(default = "four")]
    #[schemars(range(max = 1000))]
    pub messages_per_step: u32,
    /// Whether obstacles silence it.
    #[serde(default)]
    pub needs_line_of_sight: bool,
    /// Power while it is on, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power_w: f64,
}

fn four() -> u32 {
    4
}
