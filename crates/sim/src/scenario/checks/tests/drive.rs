//! Errors of drives.

use super::{GOOD, errors, read};

const DRIVE: &str = "drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }";

/// The errors with these keys in the drive of the robot on the ground.
fn errors_with(drive: &str) -> Vec<String> {
    errors(DRIVE, &format!("drive = {{ {drive} }}"))
}

#[test]
fn values_of_drive_errors_are_limited() {
    for (key, allowed) in [
        (
            "lag_s = -0.1",
            "robots.rover.drive.lag_s = -0.1: must be a number from 0 to 10 (seconds)",
        ),
        (
            "delay_s = 10.1",
            "robots.rover.drive.delay_s = 10.1: must be a number from 0 to 10 (seconds)",
        ),
        (
            "gain = 2.1",
            "robots.rover.drive.gain = 2.1: must be a number from 0 to 2",
        ),
        (
            "gain_left_right = 0",
            "robots.rover.drive.gain_left_right = 0: must be a number from 0.1 to 10",
        ),
        (
            "track_width_m = 0",
            "robots.rover.drive.track_width_m = 0: must be a number from 0.001 to 100 (metres)",
        ),
        (
            "odometry = 1",
            "robots.rover.drive.odometry = 1: must be true or false",
        ),
    ] {
        let drive = format!("max_speed_m_s = 1, max_turn_rate_deg_s = 90, {key}");
        assert_eq!(errors_with(&drive), [allowed]);
    }
    let all = "max_speed_m_s = 1, max_turn_rate_deg_s = 90, lag_s = 0.3, delay_s = 0.12, gain = 1.1, \
               gain_left_right = 1.03, track_width_m = 0.5, odometry = true";
    assert!(read(&GOOD.replace(DRIVE, &format!("drive = {{ {all} }}"))).is_ok());
}

#[test]
fn different_gains_of_the_tracks_need_a_turn_rate_and_a_distance_of_the_tracks() {
    assert_eq!(
        errors_with("max_speed_m_s = 1, gain_left_right = 1.1"),
        [
            "robots.rover.drive.max_turn_rate_deg_s is missing: expected a number from 0 to 3600 (degrees per \
             second): gain_left_right requires it"
        ]
    );
    let drive = "max_speed_m_s = 1, max_turn_rate_deg_s = 90, gain_left_right = 1.1";
    let point = format!("radius_m = 0\ndrive = {{ {drive} }}");
    let of_point = |more: &str| {
        let start = GOOD.find("[robots.rover]").unwrap();
        let rover = GOOD[start..].replacen(DRIVE, "", 1);
        let rover = rover.replacen("radius_m = 0.5", &format!("{point}{more}"), 1);
        read(&format!("{}{rover}", &GOOD[..start])).map(|_| ())
    };
    let reported = of_point("").unwrap_err().to_string();
    assert!(
        reported.contains(
            "robots.rover.drive.track_width_m is missing: expected a number from 0.001 to 100 (metres): \
             gain_left_right requires it for a robot with a radius of 0"
        ),
        "{reported}"
    );
}

#[test]
fn gains_count_for_what_a_robot_can_do_in_a_step() {
    let slow = GOOD.replace("step_s = 0.1", "step_s = 2");
    let reported = |drive: &str| {
        let text = slow.replace(DRIVE, &format!("drive = {{ {drive} }}"));
        read(&text).unwrap_err().to_string()
    };
    let turning = reported("max_speed_m_s = 1, max_turn_rate_deg_s = 90, gain = 1.1");
    assert!(
        turning.contains(
            "robots.rover.drive.gain = 1.1: must be lower: with it, the robot makes more than half a turn in one step \
             of 2 s at its maximum setpoints"
        ),
        "{turning}"
    );
    let fast = reported("max_speed_m_s = 4.99, max_turn_rate_deg_s = 45, gain_left_right = 1.1");
    assert!(
        fast.contains(
            "robots.rover.drive.gain_left_right = 1.1: must be nearer to 1: with it, the robot crosses the world in \
             one step of 2 s at its maximum setpoints"
        ),
        "{fast}"
    );
}
