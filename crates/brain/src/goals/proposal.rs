//! What a behaviour asks for.

use crate::io::command::Motion;
use base::geometry::Point;

/// What a behaviour with something to do asks for: a motion now, or to be somewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Proposal {
    Motion(Motion),
    Destination(Destination),
}

/// A place to be; how to get there is found for all behaviours alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Destination {
    /// In the world.
    pub(crate) to: Point,
    /// Nearer than this it is there.
    pub(crate) within_m: f64,
    /// At most so fast.
    pub(crate) speed_m_s: f64,
    /// What it is worth to be there, beside other aims.
    pub(crate) value: f64,
}

impl From<Motion> for Proposal {
    fn from(motion: Motion) -> Self {
        Self::Motion(motion)
    }
}
