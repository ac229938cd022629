//! The metric simulator: metres, seconds, joules, and imperfect sensors.

#![cfg_attr(
    test,
    allow(
        clippy::cast_precision_loss,
        clippy::float_cmp,
        reason = "tests count, and compare what is exact by construction"
    )
)]

pub(crate) mod agent_clock;
pub mod bodies;
pub mod clock;
pub mod controllers;
pub(crate) mod derived;
pub mod end;
pub(crate) mod failures;
pub mod goals;
pub mod judge;
pub mod passage;
pub(crate) mod poisson;
pub mod radio;
pub mod run;
pub mod runner;
pub mod scenario;
pub(crate) mod schedule;
pub mod sensors;
pub mod simulation;
pub mod step;
pub(crate) mod warnings;
pub mod world;
