//! Checks that no rate exceeds one per step.

use crate::scenario::spec::ScenarioSpec;
use crate::sensors::SensorSpec;
use base::document::Place;
use base::error::InputError;
use std::collections::BTreeMap;

/// 10 per second are one per step of 0.1 s, though the product of the floats may be slightly more.
const ROUNDING: f64 = 1e-9;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let mut rates: Vec<(Option<f64>, Place)> = Vec::new();
    for (name, robot) in &spec.robots {
        let at = at.key("robots").key(name);
        rates.extend(of_sensors(&robot.sensors, &at));
        rates.push((robot.brain.rate_hz, at.key("brain").key("rate_hz")));
    }
    for (name, kind) in &spec.controllers {
        rates.extend(of_sensors(&kind.sensors, &at.key("controllers").key(name)));
    }
    let step_s = spec.clock.step_s;
    let is_too_fast = |rate_hz: f64| rate_hz * step_s > 1.0 + ROUNDING;
    let too_fast = rates.into_iter();
    let too_fast = too_fast.filter(|(rate_hz, _)| rate_hz.is_some_and(is_too_fast));
    too_fast
        .map(|(_, at)| {
            at.error(format!(
                "at most {}, once per step of {step_s} s",
                1.0 / step_s
            ))
        })
        .collect()
}

/// The rates of sensors.
fn of_sensors<'d>(
    sensors: &BTreeMap<String, SensorSpec>,
    at: &Place<'d>,
) -> Vec<(Option<f64>, Place<'d>)> {
    let sensors = sensors.iter();
    let rates = sensors.map(|(name, sensor)| {
        let at = at.key("sensors").key(name).key("rate_hz");
        (sensor.rate_hz, at)
    });
    rates.collect()
}
