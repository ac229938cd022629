//! Validation of the simulator against closed forms. `docs/validation.md` states the claims.
//!
//! The page shows these measurements: each check compares its rows with a file in
//! `docs/validation`, and `make validation` writes these files.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

mod arcs;
mod battery;
mod belief_search;
mod blind;
mod calibration;
mod calibration_limits;
mod collisions;
mod effort;
mod false_alarms;
mod lanes;
mod mines_left;
mod paths;
mod placement;
mod poses;
mod radio;
mod random_search;
mod rows;
mod samples;
mod scans;
mod sense;
mod setup;
mod stopping;
mod vicsek;
