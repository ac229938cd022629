//! What the parts of trade share.

use brain::{AgentId, Price};

/// A price is valid for this time, in seconds, and a transfer without an effect is repeated as long.
pub(super) const PRICE_LIFE_S: f64 = 10.0;

/// Costs below this are equal, in seconds.
pub(super) const MIN_COST_S: f64 = 1.0;

/// A price that is accepted.
pub(super) struct Accepted {
    pub(super) peer: AgentId,
    pub(super) price: Price,
}
