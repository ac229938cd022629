//! The engine: a run, step by step.

mod act;
mod air;
mod decide;
mod meetings;
mod mind;
mod neighbours;
mod outcome;
mod sense;
mod share_out;
mod simulation;
mod state;
mod tick;
mod view;

pub use outcome::Outcome;
pub use simulation::Simulation;
pub use state::{NoRoom, State, Status};
