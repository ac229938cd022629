//! Checks that no rate exceeds one per step.

use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;

/// 10 per second are one per step of 0.1 s, though the product of the floats may be slightly more.
const ROUNDING: f64 = 1e-9;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    for (name, robot) in &spec.robots {
        let at = at.key("robots").key(name);
        let sensors = robot.sensors.iter().map(|(name, sensor)| {
            let at = at.key("sensors").key(name).key("rate_hz");
            (sensor.rate_hz, at)
        });
        let brain = (robot.brain.rate_hz, at.key("brain").key("rate_hz"));
        for (rate_hz, at) in sensors.chain([brain]) {
            let too_fast = rate_hz.is_some_and(|rate| rate * spec.clock.step_s > 1.0 + ROUNDING);
            if too_fast {
                errors.push(at.error(format!(
                    "at most {}, once per step of {} s",
                    1.0 / spec.clock.step_s,
                    spec.clock.step_s
                )));
            }
        }
    }
    errors
}
