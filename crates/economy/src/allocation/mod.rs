//! The rules by which goals are allocated to robots, one per file.
//!
//! A rule gets a [`Market`] and chooses pairs of a goal and a robot. It is a pure function: it has no
//! memory, and of equal bids it takes the one with the lower indices.

mod auction;
mod auction_last;
mod market;
mod nearest;
mod none;
pub(crate) mod optimal;

use alloc::vec::Vec;
use base::hashed::Hashed;
pub use market::{Market, Offer, Pair};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The rule by which a controller allocates its goals to robots.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed,
)]
#[serde(rename_all = "snake_case")]
pub enum Allocation {
    /// It awards nothing.
    None,
    /// Each goal to the nearest robot that bids.
    Nearest,
    /// Sequential single-item auction: robots bid the increment of their path.
    #[default]
    Auction,
    /// Sequential single-item auction: robots bid the whole time until they have served all of their goals.
    AuctionLast,
    /// The assignment of goals to robots, one goal per robot, with the smallest sum of times.
    Optimal,
}

impl Allocation {
    /// The pairs to award now.
    #[must_use]
    pub fn choose(self, market: &Market) -> Vec<Pair> {
        match self {
            Self::None => none::choose(market),
            Self::Nearest => nearest::choose(market),
            Self::Auction => auction::choose(market),
            Self::AuctionLast => auction_last::choose(market),
            Self::Optimal => optimal::choose(market),
        }
    }
}
