//! The area that a sensor covers, for display.

/// A sector around the robot, and what limits the view in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outline {
    pub(crate) range_m: f64,
    pub(crate) width_rad: f64,
    pub(crate) facing_rad: f64,
    pub(crate) blocked_by: BlockedBy,
}

/// What limits the view of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockedBy {
    /// Nothing: it covers its whole range.
    Nothing,
    /// Obstacles and the border of the world.
    Geometry,
    /// Everything that rays meet, robots included.
    Bodies,
}
