//! What is to be found, and what is taken for it.

use base::placement::Placement;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of item.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemSpec {
    /// Items of this kind.
    #[schemars(range(max = 1_000_000))]
    pub count: u32,
    /// Whether they are to be found; false for clutter. A run is complete when all that are sought
    /// are found.
    #[serde(default = "yes")]
    pub sought: bool,
    /// Where they are.
    #[serde(default)]
    pub placement: Placement,
}

fn yes() -> bool {
    true
}
