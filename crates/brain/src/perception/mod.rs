//! Perception: turns percepts into the robot's motion, its free space and its beliefs.

pub(crate) mod beliefs;
pub(crate) mod believed;
mod chords;
pub(crate) mod corners;
pub(crate) mod dead_reckoning;
pub(crate) mod pose_tracker;
pub(crate) mod rays;
pub(crate) mod sector;
pub(crate) mod turns;
