//! The metric simulator: metres, seconds, joules, and sensors that miss.

pub mod body;
pub mod clock;
pub mod engine;
pub mod radio;
pub mod runner;
pub mod scenario;
pub mod sensing;
pub mod world;
