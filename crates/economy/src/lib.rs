//! Controllers: agents that own goals and award them to robots, by messages only.
//!
//! A controller is a pure function from percepts and its memory to commands, as a
//! [brain](brain::Brain) is: it has no world, no clock and no shared table.
//!
//! * [`Settings`]: the controller's part of a scenario;
//! * [`Controller`]: one controller;
//! * [`Allocation`]: the rules by which a [`Market`] is cleared;
//! * [`Clearance`]: a mined lane that controllers are to clear, and [`LanePicture`], what they believe of it;
//! * [`Passage`]: vehicles that are to pass that lane, and [`PlannedPassage`], a path with its risk.

#![cfg_attr(not(test), no_std)]

extern crate alloc;

mod allocation;
mod bounds;
mod clearance;
mod controller;
mod passage;
mod settings;

pub use allocation::optimal::assignment;
pub use allocation::{Allocation, Market, Offer, Pair};
pub use clearance::{
    BelievedMark, Charge, Clearance, ClearedShare, LanePicture, LaneStatement, Risk, RobotModel,
    Skill,
};
pub use controller::{Controller, LaneConclusion, OwnedGoal, RENEWAL_RETRY_S};
pub use passage::{MineEffect, Passage, PassageGrid, PlannedPassage};
pub use settings::{Backup, Settings, Trade};
