//! A robot's mind, the same in simulation and on a real robot: a [`Percept`] comes in, a
//! [`Command`] goes out, and nothing else.
//!
//! It has no clock, file, thread or random numbers of its own: time and chance come in the percept,
//! requests and messages leave in the command. So the same percepts give the same commands,
//! wherever they come from.

mod body;
mod brain_stub;
mod command;
mod percept;
mod spec;

pub use body::{Body, RangeRing, RobotId};
pub use brain_stub::Brain;
pub use command::{About, Command, Message, Motion, SensorRequest};
pub use percept::{Contact, Heard, Neighbour, Percept, Reading, Scan};
pub use spec::BrainSpec;
