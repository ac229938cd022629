//! Perception: turns percepts into beliefs, and into the situation that behaviours read in one
//! step.

pub(crate) mod beliefs;
pub(crate) mod believed;
mod chords;
pub(crate) mod dead_reckoning;
pub(crate) mod rays;
pub(crate) mod sector;
pub(crate) mod situation;
pub(crate) mod timer;
