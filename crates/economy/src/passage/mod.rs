//! The passage of ground vehicles through a lane: a path, and the risk of each vehicle on it.
//!
//! * [`settings`]: what a controller knows of the vehicles, and what mines do to them;
//! * [`grid`]: where the centre of a vehicle can be; [`danger`]: the mines that are expected there;
//! * [`search`]: the path with the lowest expected number of mines within its width;
//! * [`swath`]: what lies within the width of that path; [`risk`]: what it does to each vehicle.

mod danger;
mod grid;
mod planned;
mod risk;
mod search;
mod settings;
mod swath;
#[cfg(test)]
mod tests;

pub use grid::PassageGrid;
pub use planned::PlannedPassage;
pub use settings::{MineEffect, Passage};
