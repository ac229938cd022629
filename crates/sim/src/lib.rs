//! The metric simulator: metres, seconds, joules, and sensors that miss.

#![cfg_attr(
    test,
    allow(
        clippy::cast_precision_loss,
        clippy::float_cmp,
        reason = "tests count, and compare what is exact by construction"
    )
)]

pub mod body;
pub mod clock;
pub mod engine;
pub mod radio;
pub mod runner;
pub mod scenario;
pub mod sensing;
pub mod world;
