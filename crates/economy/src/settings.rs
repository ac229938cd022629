//! What a person sets of a controller.

use crate::allocation::Allocation;
use crate::clearance::Clearance;
use crate::passage::Passage;
use alloc::sync::Arc;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The settings of all controllers of a kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The rule by which it allocates its goals to robots.
    pub allocation: Allocation,
    /// Time for which a robot may serve a goal without renewal.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub service_lease_s: f64,
    /// Number of controllers of the kind, whether they work or not.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub count: u32,
    /// Which of them take the goals of a lost one over.
    pub backup: Backup,
    /// Time for which a controller votes for the owner of a goal without renewal.
    #[schemars(range(min = 0.1, max = 3600.0))]
    pub owner_lease_s: f64,
    /// The terms on which it trades goals with the others of its kind; without them, it does not.
    pub trade: Option<Trade>,
    /// Time from the first call for bids to the award; at least [`answer_s`](Self::answer_s).
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub auction_s: f64,
    /// Maximum number of goals that it owns; more are refused.
    #[schemars(range(max = 10_000))]
    pub max_goals: u32,
    /// Maximum drift of any clock, in seconds per second.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub max_drift: f64,
    /// The longest time from an award until the robot's next bid has arrived: two trips over the radio, and a period of its
    /// brain. Until then, the next round waits for it.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub answer_s: f64,
    /// The lane that all controllers of the kind are to clear; without it, they plan no goals.
    #[serde(skip)]
    pub clearance: Option<Arc<Clearance>>,
    /// Vehicles that are to pass that lane once it is declared clear.
    #[serde(skip)]
    pub passage: Option<Arc<Passage>>,
    /// Whether a person ends its mission on the lane.
    #[serde(skip)]
    pub is_called_off: bool,
}

/// Which controllers of a kind take the goals of a lost one over.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Backup {
    /// A majority of the kind: a controller owns a goal only while more than half of all controllers of the kind, itself
    /// included, vote for it. n controllers survive the loss of (n - 1) / 2 of them, rounded down, without losing a goal.
    #[default]
    Majority,
    /// None: each owns its goals alone, and they are lost with it.
    None,
}

/// The terms on which controllers of a kind trade goals with each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Trade {
    /// A goal goes to another controller only if the share of its promises that this one has kept, times the probability in
    /// its robot's bid, is at least this.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub confidence: f64,
    /// A goal goes to another controller only if its cost is at most this part of the owner's, or the owner has no bid.
    #[schemars(range(min = 0.01, max = 0.99))]
    pub gain: f64,
}

impl Default for Trade {
    fn default() -> Self {
        Self {
            confidence: 0.5,
            gain: 0.7,
        }
    }
}

impl Settings {
    /// Number of votes of other controllers with which one owns a goal.
    #[must_use]
    pub fn votes_needed(&self) -> u32 {
        match self.backup {
            Backup::Majority => self.count / 2,
            Backup::None => 0,
        }
    }

    /// Time from the first call for bids to the award.
    pub(crate) fn auction_wait_s(&self) -> f64 {
        self.auction_s.max(self.answer_s)
    }

    /// The shortest service lease that outlasts an auction and a round trip over the radio of this time in seconds:
    /// a robot holds it from its bid. The clock of the robot may be fast, and that of the auction slow.
    #[must_use]
    pub fn min_service_lease_s(&self, trip_s: f64) -> f64 {
        let auction_s = self.auction_s / (1.0 - self.max_drift);
        (1.0 + self.max_drift) * (auction_s + trip_s)
    }

    /// The shortest ownership lease that counts as a vote: a shorter one could end before it is renewed.
    pub(crate) fn min_owner_lease_s(&self) -> f64 {
        self.owner_lease_s / 10.0
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            allocation: Allocation::default(),
            service_lease_s: 20.0,
            count: 1,
            backup: Backup::default(),
            owner_lease_s: 30.0,
            trade: None,
            auction_s: 1.0,
            max_goals: 1000,
            max_drift: 1e-4,
            answer_s: 0.5,
            clearance: None,
            passage: None,
            is_called_off: false,
        }
    }
}
