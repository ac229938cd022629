//! Robots and controllers, with nothing but messages between them: one binary, to link only once.

#![expect(clippy::unwrap_used, clippy::expect_used, reason = "tests may panic")]

mod controllers;
mod displacement;
mod failing;
mod failover;
mod hand;
mod lane;
mod liveness;
mod missions;
mod network;
mod quality;
mod robots;
mod safety;
mod survival;
mod sweep;
mod team;
mod trade;
mod trade_changes;
