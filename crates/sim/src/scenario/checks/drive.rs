//! Checks that a step is short enough for how fast bodies move, and that drives have what their errors need.

use crate::bodies::RobotSpec;
use crate::bodies::drive::Drive;
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
        .map(|(name, robot)| (robot, at.key("robots").key(name).key("drive")));
    let errors = robots.flat_map(|(robot, at)| {
        let mut errors = of_limits(robot, (step_s, across_m), &at);
        errors.extend(missing(robot, &at));
        if errors.is_empty() {
            errors.extend(of_gains(robot, (step_s, across_m), &at));
        }
        errors
    });
    errors.collect()
}

fn of_limits(robot: &RobotSpec, (step_s, across_m): (f64, f64), at: &Place) -> Vec<InputError> {
    let drive = &robot.drive;
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

/// What a drive with different gains needs.
fn missing(robot: &RobotSpec, at: &Place) -> Vec<InputError> {
    let drive = &robot.drive;
    if drive.has_equal_tracks() {
        return Vec::new();
    }
    let turn_rate = drive.max_turn_rate_deg_s.is_none().then(|| {
        let allowed = "a number from 0 to 3600 (degrees per second): gain_left_right requires it";
        at.key("max_turn_rate_deg_s").error(allowed)
    });
    let width = (drive.track_width_m(robot.radius_m) <= 0.0).then(|| {
        let allowed = "a number from 0.001 to 100 (metres): gain_left_right requires it for a robot with a radius of 0";
        at.key("track_width_m").error(allowed)
    });
    turn_rate.into_iter().chain(width).collect()
}

/// Gains with which a robot exceeds what its limits keep.
fn of_gains(robot: &RobotSpec, (step_s, across_m): (f64, f64), at: &Place) -> Option<InputError> {
    let spec = &robot.drive;
    let drive = Drive::new(spec, robot.radius_m, step_s);
    let has_rate = spec.max_turn_rate_deg_s.is_some();
    let turn_deg = (drive.fastest_turn_rad_s() * step_s).to_degrees();
    let limit = if drive.fastest_m_s() * step_s > across_m {
        "crosses the world"
    } else if has_rate && turn_deg > MAX_TURN_DEG {
        "makes more than half a turn"
    } else {
        return None;
    };
    let (key, nearer) = if spec.has_equal_tracks() {
        ("gain", "lower")
    } else {
        ("gain_left_right", "nearer to 1")
    };
    Some(at.key(key).error(format!(
        "{nearer}: with it, the robot {limit} in one step of {step_s} s at its maximum setpoints"
    )))
}
