//! Building blocks that all other crates share.
//!
//! * [`geometry`], [`trig`]: points, walls, pillars and polygons; trigonometry that returns the same
//!   bits on every machine;
//! * [`geodesy`]: geographic coordinates and bearings, and those of a world;
//! * [`random`], [`philox`], [`noise`]: counter-based random streams, keyed by (seed, run, entity,
//!   purpose), and the distributions drawn from them;
//! * [`hash`], [`hashed`]: a hash of simulation states, and the values that it covers;
//! * [`map`]: ROS occupancy maps;
//! * [`placement`]: random positions of items and robots without overlaps;
//! * [`reachability`]: the parts of a world that a robot cannot reach;
//! * [`error`], [`warning`]: errors of user input, and warnings about it;
//! * [`document`]: TOML documents, checked as a whole, with all errors reported at once;
//! * [`engine`]: the seam between simulators and studies, [`engine::Engine`] and [`engine::Runner`];
//! * [`scenario`]: the part of a scenario that is common to all engines.

// The derive macro of `Hashed` names this crate.
extern crate self as base;

pub mod document;
pub mod engine;
pub mod error;
pub mod geodesy;
pub mod geometry;
pub mod hash;
pub mod hashed;
pub mod map;
pub mod noise;
pub mod philox;
pub mod placement;
pub mod random;
pub mod reachability;
pub mod scenario;
pub mod trig;
pub mod warning;
