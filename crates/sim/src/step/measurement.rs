//! One measurement of one sensor of a robot.

use super::destination::Destination;
use super::robot_scene::RobotScene;
use super::view::View;
use crate::sensors::Sensor;
use crate::sensors::backlog::Backlog;
use crate::sensors::buffers::Buffers;
use crate::sensors::sensor_frame::SensorFrame;

/// One measurement.
pub(super) struct Measurement<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) robot: usize,
    pub(super) sensor: &'a Sensor,
    pub(super) frame: SensorFrame<'a>,
    /// Index of the sensor on the robot, and of a range sensor among the range sensors.
    pub(super) number: usize,
    pub(super) ring: usize,
}

impl Measurement<'_> {
    /// Takes the measurement; its results go to `destination`.
    #[inline]
    pub(super) fn take(&self, buffers: &mut Buffers, mut destination: Destination) {
        if self.sensor.is_dropped(&self.frame) {
            return;
        }
        let scene = RobotScene {
            view: self.view,
            robot: self.robot,
            at: self.frame.at,
        };
        let measure = &self.sensor.measure;
        measure.measure(&self.frame, &scene, buffers, &mut destination);
        if !self.sensor.facts.detects {
            self.store_values(&mut buffers.values, destination);
        }
    }

    /// The backlog as a destination: the result waits there for the latency of the sensor.
    pub(super) fn later<'b>(&self, backlog: &'b mut Backlog) -> Destination<'b> {
        let taken = self.view.tick;
        Destination::Backlog {
            backlog,
            taken,
            due: taken + self.sensor.latency_steps,
        }
    }

    /// Stores measured values, which the next measurement replaces.
    #[inline]
    fn store_values(&self, values: &mut Vec<f64>, destination: Destination) {
        match destination {
            Destination::Percept { percept, .. } => {
                let measure = &self.sensor.measure;
                measure.write(percept, self.ring, 0.0, values);
            }
            Destination::Backlog { backlog, taken, .. } => {
                if let Some(stored) = backlog.keep(self.number, taken) {
                    std::mem::swap(stored, values);
                }
            }
        }
    }
}
