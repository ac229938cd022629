//! The engine: a run, step by step.

mod act;
mod air;
mod asked;
mod change;
mod danger;
mod decide;
mod flocks;
mod footprints;
mod glide;
mod links;
mod meetings;
mod mind;
mod neighbours;
mod outcome;
mod outside;
mod seen;
mod sense;
mod share_out;
mod simulation;
pub(crate) mod sizes;
mod state;
mod stay;
mod tick;
mod view;
mod waiting;
mod watch;

pub use asked::Asked;
pub use footprints::{Footprint, Sensors};
pub use links::Link;
pub use outcome::Outcome;
pub use outside::Outside;
pub use seen::{Item, Robot};
pub use simulation::{NoRobot, Simulation};
pub use state::{NoRoom, State, Status};
pub use watch::Watched;

pub(crate) use tick::Workshop;
