//! The body that all programs simulate.

/// Radius of every robot, in metres.
pub(crate) const RADIUS_M: f64 = 0.2;
/// Range of the rays, in metres.
pub(crate) const RANGE_M: f64 = 3.0;
pub(super) const STEP_S: f64 = 0.1;
pub(super) const SPEED_M_S: f64 = 0.5;
pub(super) const TURN_RAD_S: f64 = 1.5;
