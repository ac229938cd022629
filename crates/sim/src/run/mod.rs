//! A run: its state between two steps, what it yields, and how it continues with another scenario.

pub(crate) mod agent;
mod carry_over;
mod change;
pub(crate) mod outcome;
pub(crate) mod snapshot;
pub(crate) mod state;
mod state_hash;

pub use outcome::Outcome;
pub use snapshot::{Item, Robot};
pub use state::{NoRoom, State, Status};
