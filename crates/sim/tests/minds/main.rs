//! What robots with minds do in the simulator: one thing a file.

#![expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "tests panic when what they ask for is wrong"
)]

mod crossing;
mod errands;
mod moving;
mod searching;
