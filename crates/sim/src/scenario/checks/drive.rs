//! Checks that a step is short enough for how fast bodies move.

use crate::bodies::drive::DriveSpec;
use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;

/// Beyond half a turn per step, a robot could as well turn the other way.
const MAX_TURN_DEG: f64 = 180.0;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let step_s = spec.clock.step_s;
    let [width, height] = spec.world.size_m;
    let across_m = width.0.min(height.0);
    let robots = spec
        .robots
        .iter()
        .map(|(name, robot)| (&robot.drive, at.key("robots").key(name)));
    robots
        .flat_map(|(drive, at)| errors_of(drive, (step_s, across_m), &at.key("drive")))
        .collect()
}

fn errors_of(drive: &DriveSpec, (step_s, across_m): (f64, f64), at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    for (key, speed) in [
        ("max_speed_m_s", drive.max_speed_m_s),
        ("max_reverse_speed_m_s", drive.max_reverse_speed_m_s),
    ] {
        if speed * step_s > across_m {
            errors.push(at.key(key).error(format!(
                "at most {}, at which it crosses the world in one step of {step_s} s",
                across_m / step_s
            )));
        }
    }
    let turn_rate = drive.max_turn_rate_deg_s;
    if turn_rate.is_some_and(|turn_rate| turn_rate * step_s > MAX_TURN_DEG) {
        errors.push(at.key("max_turn_rate_deg_s").error(format!(
            "at most {}, half a turn in one step of {step_s} s",
            MAX_TURN_DEG / step_s
        )));
    }
    errors
}
