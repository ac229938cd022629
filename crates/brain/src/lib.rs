//! A robot's mind, the same in simulation and on a real robot: a [`Percept`] comes in, a
//! [`Command`] goes out, and nothing else.
//!
//! It has no clock, file, thread or random numbers of its own: time and chance come in the percept,
//! requests and messages leave in the command. So the same percepts give the same commands,
//! wherever they come from. The compiler sees to it: without `std` there is no clock, file, thread,
//! environment or network to be had.
//!
//! * [`Percept`], [`Command`], [`Body`]: the seam;
//! * [`BrainSpec`]: what a scenario says of a brain;
//! * [`Brain`]: the mind of one robot.
//!
//! ```
//! use brain::{Body, Brain, BrainSpec, Percept};
//! use std::sync::Arc;
//! let body = Body {
//!     radius_m: 0.25,
//!     max_speed_m_s: 1.0,
//!     max_acceleration_m_s2: 1.0,
//!     max_turn_rate_rad_s: 1.5,
//!     period_s: 0.1,
//!     ..Body::default()
//! };
//! let mut brain = Brain::new(Arc::new(BrainSpec::default()), Arc::new(body));
//! // It has no range sensor and touches nothing: ahead, as fast as it can.
//! assert_eq!(brain.step(&Percept::default()).motion.speed_m_s, 1.0);
//! ```

#![cfg_attr(not(test), no_std)]

extern crate alloc;

mod arbitration;
pub mod behaviours;
mod beliefs;
mod believed_map;
mod body;
mod brain;
mod command;
mod decision;
mod dice;
mod goals;
mod infinite;
mod mind;
mod percept;
mod rays;
mod reach;
mod reckoning;
mod schemas;
mod sector;
mod senses;
mod sight;
mod spec;
mod subsumption;
mod thoughts;
mod way;
mod wish;
#[cfg(test)]
mod world_of_walls;

pub use arbitration::Arbitration;
pub use beliefs::pose::Pose;
pub use beliefs::{BeliefsSpec, TrustSpec};
pub use believed_map::BelievedMap;
pub use body::{Body, Detector, Other, RangeRing, RobotId};
pub use brain::Brain;
pub use command::{About, Command, Message, Motion, Seen, SensorRequest, Stand};
pub use decision::Decision;
pub use dice::Dice;
pub use goals::Verdict;
pub use percept::{Contact, Heard, Look, Neighbour, Percept, Reading, Scan};
pub use reach::{Course, Reach};
pub use schemas::Schemas;
pub use spec::BrainSpec;
pub use thoughts::{BelievedItem, BelievedRobot, Thoughts, Wanted};
