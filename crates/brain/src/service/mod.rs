//! Goals that controllers own, and robots serve: leases, and the robot's half of the protocol.
//!
//! * [`numbers`]: numbers of requests, which never repeat; [`operator_reports`]: what the operator is to know;
//! * [`holder`] and [`grantor`]: the two halves of a lease, for robots and controllers;
//! * [`assignee`]: the robot's half, a step as a table of contents, with [`bids`],
//!   [`renewals`] and [`reporting`], the [`jobs`] that it serves, its known [`offers`], its
//!   [`failures`], and when it sends what ([`schedule`]);
//! * [`lane_reports`]: what it reports of a mined lane, [`lane_coverage`], [`lane_driven`] and
//!   [`lane_marks`].

pub(crate) mod ability;
pub(crate) mod assignee;
mod bidding;
mod bids;
pub(crate) mod charge_state;
mod charges;
mod failures;
mod finished;
pub(crate) mod grantor;
pub(crate) mod holder;
pub(crate) mod jobs;
mod lane_coverage;
mod lane_driven;
mod lane_marks;
mod lane_masks;
pub(crate) mod lane_reports;
pub(crate) mod lanes;
pub(crate) mod numbers;
mod offers;
pub(crate) mod operator_reports;
mod reach;
mod renewals;
mod reporting;
mod schedule;
pub(crate) mod served;
mod set_hash;
