//! Buffers for measurements, kept so that nothing is allocated.

use super::rays::{GROUP, Near};
use super::scene::Scene;

/// Buffers for the measurements of one robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Buffers {
    /// With what the rays of the robot can meet, once one of its range sensors has measured.
    pub(super) rays: RingBuffers,
    is_near_known: bool,
    /// The values of a measurement.
    pub(crate) values: Vec<f64>,
    /// Robots that may be detected.
    pub(super) others: Vec<u32>,
}

impl Buffers {
    /// Drops what belongs to the robot before.
    pub(crate) fn begin_robot(&mut self) {
        self.is_near_known = false;
    }

    /// Gathers what the rays of the robot can meet, once for all of its range sensors.
    #[inline]
    pub(super) fn gather(&mut self, scene: &impl Scene) {
        if !self.is_near_known {
            scene.gather(&mut self.rays.near);
            self.is_near_known = true;
        }
    }
}

/// Buffers for measurements of rings.
#[derive(Debug, Clone, Default)]
pub(crate) struct RingBuffers {
    pub(crate) near: Near,
    /// Normal deviates of the rays.
    pub(super) deviations: Vec<[f64; GROUP]>,
}
