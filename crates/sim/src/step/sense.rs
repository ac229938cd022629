//! The measurements of one robot in one step.
//!
//! When the brain steps, sensors without latency write directly into the percept, and measurements
//! from the backlog that have arrived are added. All other measurements go into the backlog.

use super::destination::Destination;
use super::measurement::Measurement;
use super::view::View;
use crate::judge::detections::Detections;
use crate::run::agent::{Agent, is_on};
use crate::sensors::Sensor;
use crate::sensors::backlog::{Backlog, age_s};
use crate::sensors::buffers::Buffers;
use crate::sensors::sensor_frame::SensorFrame;
use brain::Percept;

/// Buffers for measurements, and what the judge counts of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SensingScratch {
    buffers: Buffers,
    pub(crate) detections: Detections,
}

/// Takes the measurements of a robot whose brain steps now, and fills its percept.
pub(crate) fn sense(
    view: &View,
    robot: usize,
    agent: &mut Agent,
    scratch: &mut SensingScratch,
    percept: &mut Percept,
) {
    scratch.buffers.begin_robot();
    for measurement in due(view, robot, agent.sensors_off) {
        let destination = match &mut agent.inputs.backlog {
            Some(backlog) if !measurement.sensor.delivers_at_once() => measurement.later(backlog),
            // Kinds without backlog have only sensors that deliver at once.
            _ => Destination::Percept {
                percept,
                detections: &mut scratch.detections,
                robot,
            },
        };
        measurement.take(&mut scratch.buffers, destination);
    }
    if let Some(backlog) = &mut agent.inputs.backlog {
        deliver(view, robot, backlog, scratch, percept);
    }
}

/// Takes the measurements of a robot between two steps of its brain; they wait in its backlog.
pub(crate) fn sense_between_steps(
    view: &View,
    robot: usize,
    agent: &mut Agent,
    scratch: &mut SensingScratch,
) {
    let Some(backlog) = &mut agent.inputs.backlog else {
        return;
    };
    backlog.forget_detections(view.tick);
    scratch.buffers.begin_robot();
    for measurement in due(view, robot, agent.sensors_off) {
        if measurement.sensor.outlasts_a_step() {
            measurement.take(&mut scratch.buffers, measurement.later(backlog));
        }
    }
}

/// The measurements that are due in this step, of the sensors that are on.
fn due<'a>(
    view: &'a View<'a>,
    robot: usize,
    sensors_off: u32,
) -> impl Iterator<Item = Measurement<'a>> {
    let sensors_off = sensors_off | view.unmeasured(robot);
    let at = view.sensing_place(robot);
    numbered(&view.kind(robot).sensors).filter_map(move |(number, ring, sensor)| {
        let measurement = sensor.schedule.due(view.tick)?;
        is_on(sensors_off, number).then(|| Measurement {
            view,
            robot,
            sensor,
            frame: SensorFrame {
                at,
                ..view.sensor_frame(robot, number, measurement)
            },
            number,
            ring,
        })
    })
}

/// Sensors with their indices on the robot, and those of range sensors among the range sensors.
fn numbered(sensors: &[Sensor]) -> impl Iterator<Item = (usize, usize, &Sensor)> {
    let mut rings = 0;
    sensors.iter().enumerate().map(move |(number, sensor)| {
        let ring = rings;
        rings += usize::from(sensor.facts.is_ring);
        (number, ring, sensor)
    })
}

/// Moves what has arrived from the backlog into the percept.
fn deliver(
    view: &View,
    robot: usize,
    backlog: &mut Backlog,
    scratch: &mut SensingScratch,
    percept: &mut Percept,
) {
    let (now, step_s) = (view.tick, view.scenario.step_s);
    let values = &mut scratch.buffers.values;
    for (number, ring, sensor) in numbered(&view.kind(robot).sensors) {
        if let Some((taken, newest)) = backlog.newest(number, sensor.latency_steps, now) {
            values.clear();
            values.extend_from_slice(newest);
            let age_s = age_s(taken, now, step_s);
            sensor.measure.write(percept, ring, age_s, values);
        }
    }
    backlog.deliver(now, step_s, percept, |item| {
        scratch.detections.note(robot, item);
    });
}
