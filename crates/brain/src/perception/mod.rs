//! Perception: percepts become beliefs, and a situation for the behaviours of one step.

pub(crate) mod beliefs;
pub(crate) mod believed;
pub(crate) mod dead_reckoning;
pub(crate) mod rays;
pub(crate) mod sector;
pub(crate) mod situation;
