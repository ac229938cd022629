//! The simulator through its public interface: one binary, to link only once.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    clippy::format_push_string,
    clippy::needless_for_each,
    clippy::panic,
    clippy::similar_names,
    clippy::unnecessary_wraps,
    clippy::unwrap_used,
    reason = "tests count, compare values that are exact by construction, write scenarios, and may panic"
)]

mod bundled;
mod common;
mod documents;
mod engine;
#[path = "../scenarios/mod.rs"]
mod scenarios;
mod schemas;
