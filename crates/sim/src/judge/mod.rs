//! Judging a run: what is counted, when the run is over, and its outcome. Robots perceive none of it.
//!
//! A step reports to the [`tally`] what robots detected, and how often they collided. From the tally
//! and the bodies of a [`moment`] follow the rules of the [`end`] and the [`outcome`], whose numbers are
//! the [`columns`] of results. What counts is also an event for the readers of [`events`], if there are any.

mod act_columns;
pub(crate) mod act_outcome;
pub(crate) mod act_tally;
mod bounds;
mod clearance_columns;
pub(crate) mod clearance_outcome;
pub(crate) mod clearance_tally;
pub(crate) mod columns;
pub(crate) mod conclusion_tally;
pub(crate) mod cost;
pub(crate) mod detections;
mod end;
pub mod events;
mod find_times;
mod goal_columns;
pub(crate) mod goal_moment;
pub(crate) mod goal_outcome;
pub(crate) mod goal_tally;
pub(crate) mod items;
mod journey;
pub(crate) mod moment;
mod outcome;
mod passage_columns;
mod passage_outcome;
mod stays;
pub(crate) mod tally;
mod unseen;

pub use clearance_outcome::{ClearanceOutcome, KindUse};
pub use conclusion_tally::StatedClearance;
pub use end::LaneEnd;
pub use goal_outcome::GoalOutcome;
pub use outcome::Outcome;
pub use passage_outcome::PassageOutcome;
