//! Vehicles that pass a lane once it has been declared clear.
//!
//! Controllers plan the path, and state the risk of each vehicle (`economy::Passage`). The vehicles then drive along it
//! one after the other: they have no sensors and no brain, and mines within the width of the path destroy them.

pub(crate) mod convoy;
mod ready;
mod spec;

pub use convoy::{Vehicle, VehicleStatus};
pub use spec::PassageSpec;
