//! Truth: the simulator checked against closed forms. `docs/validation.md` tells what is claimed.
//!
//! What is measured here is also what the page shows: each check compares its rows with a file in
//! `docs/validation`, and `make validation` writes these files.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

mod arcs;
mod battery;
mod calibration;
mod collisions;
mod false_alarms;
mod lanes;
mod looks;
mod placement;
mod radio;
mod random_search;
mod rows;
mod search_minds;
mod sense;
mod setup;
mod stopping;
mod vicsek;
mod ways;
