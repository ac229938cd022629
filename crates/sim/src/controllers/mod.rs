//! Controllers: agents that own goals and award them to robots. They have no body.

pub(crate) mod clearance;
pub(crate) mod kind;
pub(crate) mod lane;

use crate::radio::RadioSpec;
use crate::sensors::SensorSpec;
use base::placement::Placement;
use clearance::ClearanceSpec;
use economy::{Allocation, Backup, Settings, Trade};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A kind of controller, and the number of these controllers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ControllerSpec {
    /// Number of controllers of this kind. They count as no robots.
    #[schemars(range(max = 1000))]
    pub count: u32,
    /// Where the controllers are, on the ground; by default anywhere. They do not move, and no robot collides with them.
    pub start: Option<Placement>,
    /// A kind of robots that carries the controllers, instead of `start`: the first controller is aboard its
    /// first robot, and so on. A controller works only while its robot does.
    pub aboard: Option<String>,
    /// The radio.
    pub radio: RadioSpec,
    /// Detectors of robots and other controllers, of `kind = "robots"`, each under a name of your choice. A controller
    /// faces along the x axis. It reports what it detects to the other controllers.
    #[serde(default)]
    pub sensors: BTreeMap<String, SensorSpec>,
    /// Price of one controller, in the currency of the robots' prices. The outcome `price` includes it.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e12))]
    pub price: f64,
    /// Mean time until a controller fails, in seconds; it is silent from then on. Without it, none fails.
    #[schemars(range(min = 0.001, max = 1e12))]
    pub mean_time_between_failures_s: Option<f64>,
    /// Indices of controllers that have failed: from the start, or from when this changes in a run. They
    /// stay silent when their index is removed. Others than those of the team have no effect.
    #[serde(default)]
    pub failed: Vec<u32>,
    /// The rule by which it allocates its goals to robots.
    #[serde(default)]
    pub allocation: Allocation,
    /// Time for which a robot may serve a goal without renewal, in seconds.
    #[serde(default = "service_lease_s")]
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub service_lease_s: f64,
    /// Which controllers take the goals of a lost one over.
    #[serde(default)]
    pub backup: Backup,
    /// Trade between the controllers of the kind: goals go to the one that can have them served. Without it, they stay where
    /// they were issued. Goals of a mined lane are not traded.
    pub trade: Option<Trade>,
    /// Time for which a controller votes for the owner of a goal without renewal, in seconds.
    #[serde(default = "owner_lease_s")]
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub owner_lease_s: f64,
    /// Time from a call for bids to the award, in seconds.
    #[serde(default = "auction_s")]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub auction_s: f64,
    /// Maximum number of goals that are issued or transferred to one controller; more are refused. It takes those of lost
    /// controllers over beyond it.
    #[serde(default = "max_goals")]
    #[schemars(range(max = 10_000))]
    pub max_goals: u32,
    /// A mined lane that they are to clear. Only one kind of controllers can have one.
    pub clearance: Option<ClearanceSpec>,
}

fn service_lease_s() -> f64 {
    Settings::default().service_lease_s
}

fn owner_lease_s() -> f64 {
    Settings::default().owner_lease_s
}

fn auction_s() -> f64 {
    Settings::default().auction_s
}

fn max_goals() -> u32 {
    Settings::default().max_goals
}
