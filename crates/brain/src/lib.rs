//! The brain of a robot, identical in simulation and on a real robot: a pure function from a
//! [`Percept`] and its memory to a [`Command`].
//!
//! It uses no clock, file, thread or random numbers: time and random words are part of the percept,
//! requests and messages are part of the command. So the same percepts always give the same
//! commands. The compiler enforces this: without `std` there is no clock, file, thread, environment
//! or network.
//!
//! * [`Percept`], [`Command`], [`Body`]: the interface;
//! * [`BrainSpec`]: the brain's part of a scenario;
//! * [`Brain`]: the brain of one robot.
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
//! // Without range sensors and contacts it drives straight ahead at maximum speed.
//! assert_eq!(brain.step(&Percept::default()).motion.speed_m_s, 1.0);
//! ```

#![cfg_attr(not(test), no_std)]

extern crate alloc;

pub mod arbitration;
pub mod behaviours;
mod brain;
mod goals;
mod inspect;
mod io;
mod messaging;
mod navigation;
mod perception;
mod service;
mod situation;
mod spec;
#[cfg(test)]
mod world_of_walls;

pub use arbitration::Arbitration;
pub use arbitration::motor_schemas::Schemas;
pub use brain::Brain;
pub use goals::Verdict;
pub use goals::orders::{AssignedGoal, OrderVerdict};
pub use goals::proposal::max_deviation_m;
pub use inspect::{BeliefState, BelievedMap, Decision, GoalState, HeadingOption, HeadingOptions};
pub use io::act::{Act, ActKind, Acted, MAX_ACTS, Tool};
pub use io::agent_id::{AgentId, AgentRole, Receiver};
pub use io::body::{Body, Detector, Other, RangeRing};
pub use io::command::{Command, Motion, SensorRequest};
pub use io::contract::{Award, Bid, ContractMessage, Fitness, Refusal, Report};
pub use io::goal_id::{GoalId, GoalList, Issuer, issuer_of};
pub use io::lease::{Claim, LeaseMessage, Renewal};
pub use io::message::{About, CommitmentStatus, Message, OrderAction, Provenance};
pub use io::ownership::{Assignment, Entrust, OwnershipMessage, Seen};
pub use io::percept::{Contact, Neighbour, Observation, Percept, Reading, ReceivedMessage, Scan};
pub use io::random_words::RandomWords;
pub use io::reason::Reason;
pub use io::trade::{Price, TradeMessage, TradeOffer, Transfer};
pub use io::work::lane::{
    CELLS_PER_MESSAGE, Coverage, HAS_ANOTHER, Lane, LaneMessage, MARK_KINDS, Mark, MarkVerdict,
    Statement,
};
pub use io::work::{Task, Work};
pub use navigation::hazards::min_work_range_m;
pub use navigation::speed_governor::stopping_m;
pub use perception::beliefs::pose::Pose;
pub use perception::beliefs::{BeliefsSpec, TrustSpec};
pub use perception::believed::{BelievedItem, BelievedRobot};
pub use perception::corners::MAX_CORNER_SINE;
pub use perception::pose_tracker::PoseTracker;
pub use service::grantor::{Grant, Grantor, wait_s};
pub use service::holder::{Holder, Lease};
pub use service::lane_reports::{LANE_REPORT_MESSAGES, LANE_REPORT_PERIOD_S};
pub use service::numbers::Numbers;
pub use service::operator_reports::OperatorReports;
pub use service::served::ServedGoal;
pub use spec::BrainSpec;
