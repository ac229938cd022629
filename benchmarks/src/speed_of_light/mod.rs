//! Speed of light: a program that can only do the work of the sensing team.
//!
//! Disc robots of one size with sixteen exact rays of 3 m, a minimal random reactive brain, a
//! differential drive, a battery, and contacts that push back. Every quantity is an array of its own,
//! robots are sorted by position whenever neighbour lists are rebuilt, and a whole step is one function,
//! compiled for the widest vectors of the machine. It shares only sines and noise with the simulator, and
//! lacks everything that makes the simulator useful: kinds of robots, sensors, latency, layers of
//! behaviours, messages, the order of collisions, and results that do not depend on the number of
//! threads.

#![expect(
    clippy::needless_bitwise_bool,
    reason = "branches would be mispredicted"
)]

mod constants;
mod lists;
mod rays;
mod room;
mod step;
mod team;

pub(crate) use team::Team;
