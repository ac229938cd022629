//! A run: its state between two steps, and how it continues with another scenario.

pub(crate) mod acting;
pub(crate) mod agent;
mod carry_over;
mod change;
pub(crate) mod controller;
mod economy;
mod external;
mod failing;
mod fixed;
mod fixed_passage;
mod goal_life;
mod goals;
mod lane;
mod operator;
pub(crate) mod participant;
pub(crate) mod placing;
mod service;
pub(crate) mod snapshot;
pub(crate) mod state;
mod state_hash;

pub use crate::bodies::body_state::Status;
pub use economy::{Controller, Goal};
pub use goal_life::GoalStatus;
pub use lane::BelievedLane;
pub use placing::NoRoom;
pub use snapshot::{Item, Robot};
pub use state::State;
