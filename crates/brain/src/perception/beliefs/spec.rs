//! The settings of beliefs.

use alloc::collections::BTreeMap;
use alloc::string::String;
use base::geometry::Rectangle;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The beliefs of a brain: their area, resolution and priors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BeliefsSpec {
    /// The area that it searches and maps, two opposite corners in metres; the whole world by default.
    pub area_m: Option<Rectangle>,
    /// Minimum cell width of its maps, in metres.
    #[schemars(range(min = 0.05, max = 1000.0))]
    pub cell_m: f64,
    /// Maximum number of cells of its maps; each needs about 20 bytes per robot.
    #[schemars(range(min = 16, max = 65_000))]
    pub cells: u32,
    /// Expected number of items of each kind before any observation; one of each kind by default.
    pub prior_count: BTreeMap<String, f64>,
    /// Maximum number of items that it keeps track of; the least likely one is replaced first. Each
    /// needs about 600 bytes per robot.
    #[schemars(range(min = 1, max = 1024))]
    pub max_tracks: u32,
    /// Trust in the reports of other robots.
    pub trust: TrustSpec,
}

impl Default for BeliefsSpec {
    fn default() -> Self {
        Self {
            area_m: None,
            cell_m: 0.25,
            cells: 4096,
            prior_count: BTreeMap::new(),
            max_tracks: 64,
            trust: TrustSpec::default(),
        }
    }
}

/// How far a brain trusts the reports of other robots.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(default, deny_unknown_fields)]
pub struct TrustSpec {
    /// Initial trust in a robot, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub initial: f64,
    /// Whether trust changes when the robot's own observations confirm or refute reports.
    pub adaptive: bool,
}

impl Default for TrustSpec {
    fn default() -> Self {
        Self {
            initial: 0.9,
            adaptive: true,
        }
    }
}
