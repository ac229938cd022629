//! The beliefs of a robot, computed from percepts: the *identifier* of Rodin and Amin's
//! architecture, which has an identifier, a [goal selector](crate::goals) and an
//! [adapter](crate::navigation::navigator).
//!
//! Memory is bounded: with its goals and paths, a brain needs at most 62 kB, plus 20 bytes for each
//! of at most [`BeliefsSpec::cells`] cells, plus 40 bytes per ray, plus 50 kB if
//! readings are late, plus 48 bytes per track if items may destroy the robot, plus 300 bytes per track
//! in a mined lane. A test measures this, without such items and lanes.

mod battery;
mod covariance;
pub(crate) mod coverage_map;
pub(crate) mod displacement;
mod drive_estimate;
pub(crate) mod field;
pub(crate) mod items;
mod last_places;
mod localisation;
mod map;
pub(crate) mod mover;
pub(crate) mod occupancy;
pub(crate) mod others;
mod own_path;
pub(crate) mod pose;
mod pose_filter;
mod pose_history;
mod readings;
mod scan_objects;
mod scans;
mod spec;
mod validation_gate;
pub(crate) mod view;
mod world_model;

pub(crate) use drive_estimate::DriveEstimate;
pub(crate) use localisation::Localisation;
pub(crate) use map::Map;
pub(crate) use scans::static_hits;
pub use spec::{BeliefsSpec, TrustSpec};
pub(crate) use world_model::Beliefs;
