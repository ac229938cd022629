//! Arbitration: how one motion results from what all behaviours propose.

pub(crate) mod arbiter;
pub(crate) mod decided;
pub(crate) mod goal_selection;
pub mod motor_schemas;
mod spec;
pub(crate) mod subsumption;

pub use spec::Arbitration;
