//! A run fits into memory.

use super::ScenarioSpec;
use crate::body::RobotSpec;
use crate::sensing::{Measures, SensorSpec};
use base::document::Place;
use base::fault::Fault;

/// Most bytes of a run, about: as many runs as there are processor cores are made at once.
const MAX_BYTES: f64 = 4e9;

/// A robot's state, its brain and its share of the indices, about.
const ROBOT_BYTES: f64 = 2_000.0;

/// A message or a contact, about.
const MESSAGE_BYTES: f64 = 64.0;

/// A distance.
const RAY_BYTES: f64 = 8.0;

/// An item, about.
const ITEM_BYTES: f64 = 64.0;

pub(super) fn faults(spec: &ScenarioSpec, at: &Place) -> Vec<Fault> {
    let step_s = spec.clock.step_s;
    let items = spec.items.iter().map(|(name, kind)| {
        let bytes = f64::from(kind.count) * ITEM_BYTES;
        (bytes, at.key("items").key(name))
    });
    let robots = spec.robots.iter().map(|(name, robot)| {
        let bytes = f64::from(robot.count) * bytes_of(robot, step_s);
        (bytes, at.key("robots").key(name))
    });
    let all: Vec<(f64, Place)> = items.chain(robots).collect();
    let total: f64 = all.iter().map(|(bytes, _)| bytes).sum();
    let largest = all.iter().max_by(|one, other| one.0.total_cmp(&other.0));
    let largest = largest.filter(|_| total > MAX_BYTES);
    let told = largest.map(|(bytes, at)| {
        at.key("count").fault(format!(
            "fewer, or with fewer rays and messages: a run may take {} GB of memory, and this one \
             takes about {:.1} GB, {:.1} GB for these",
            MAX_BYTES / 1e9,
            total / 1e9,
            bytes / 1e9
        ))
    });
    told.into_iter().collect()
}

fn bytes_of(robot: &RobotSpec, step_s: f64) -> f64 {
    let sensors: f64 = robot
        .sensors
        .values()
        .map(|sensor| bytes_of_sensor(sensor, step_s))
        .sum();
    let messages = robot.radio.map_or(0.0, |radio| {
        f64::from(radio.messages_per_step) * (1.0 + radio.delay_s / step_s)
    });
    ROBOT_BYTES + sensors + MESSAGE_BYTES * messages
}

/// What the looks that are still under way take.
fn bytes_of_sensor(sensor: &SensorSpec, step_s: f64) -> f64 {
    let period_s = sensor.rate_hz.map_or(step_s, |rate_hz| 1.0 / rate_hz);
    let looks = 1.0 + sensor.latency_s / period_s;
    let bytes = match &sensor.measures {
        Measures::Range(range) => f64::from(range.rays) * RAY_BYTES,
        _ => MESSAGE_BYTES,
    };
    looks * bytes
}
