//! Navigation: how to reach a destination, and how fast it is safe to move.

pub(crate) mod hazards;
pub(crate) mod navigator;
pub(crate) mod path;
pub(crate) mod reachable;
pub(crate) mod shunting;
pub(crate) mod speed_governor;
pub(crate) mod traffic;
