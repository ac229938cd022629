//! What every other crate may use, and nothing else.
//!
//! * [`geometry`], [`trig`]: points, walls, pillars and polygons; sines that are the same on every
//!   machine;
//! * [`random`]: random streams keyed by (seed, run, entity, purpose);
//! * [`hash`]: telling states apart;
//! * [`map`]: occupancy maps of ROS;
//! * [`placement`]: where items and robots are put, by rejection and without overlaps;
//! * [`reach`]: which places no robot can come to;
//! * [`error`]: what is wrong with something a person wrote, in words;
//! * [`document`]: a TOML document read against what is allowed, every error at once;
//! * [`runner`]: the seam between simulators and studies;
//! * [`question`]: what a study asks, alike for every simulator.

pub mod document;
pub mod error;
pub mod geometry;
pub mod hash;
pub mod map;
pub mod noise;
pub mod philox;
pub mod placement;
pub mod question;
pub mod random;
pub mod reach;
pub mod runner;
pub mod trig;
