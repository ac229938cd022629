//! Messages between robots: received, weighted by trust, and sent.
//!
//! In every step, [`receive`] updates the beliefs with the messages of the percept, and
//! [`broadcast`] adds those that are due to the command. [`peers`] are the team mates as their
//! messages describe them, [`trust`] is the share of their reports that the robot's own
//! observations confirmed, and [`reports`] combines reports of items by it.

mod broadcast;
pub(crate) mod commitment;
pub(crate) mod peers;
pub(crate) mod phase;
mod receive;
pub(crate) mod reports;
mod state;
pub(crate) mod trust;
mod visits;

pub(crate) use state::Messaging;

#[cfg(test)]
mod tests;
