use super::*;
use proptest::prelude::*;

const ROVER: Drive = Drive {
    max_speed_m_s: 2.0,
    max_reverse_speed_m_s: 1.0,
    max_acceleration_m_s2: 4.0,
    max_turn_rate_rad_s: 1.5,
    turns_at_once: false,
    has_odometry: true,
    errors: None,
};

fn motion(speed_m_s: f64, turn_rate_rad_s: f64) -> Motion {
    Motion {
        speed_m_s,
        turn_rate_rad_s,
    }
}

/// Distance covered in a number of steps until the body has stopped.
fn stopping_m(drive: &Drive, speed_m_s: f64, step_s: f64) -> f64 {
    let (mut speed, mut way) = (speed_m_s, 0.0);
    while speed != 0.0 {
        let driven = drive.step(speed, Motion::default(), 1.0, step_s);
        (speed, way) = (driven.speed_m_s, way + driven.length_m);
    }
    way
}

#[test]
fn the_stopping_distance_is_that_of_the_closed_form_for_any_step() {
    for step_s in [0.001, 0.07, 0.1, 0.3, 2.0] {
        // v^2 / (2 a), forward and in reverse.
        assert!(
            (stopping_m(&ROVER, 2.0, step_s) - 0.5).abs() < 1e-12,
            "{step_s}"
        );
        assert!(
            (stopping_m(&ROVER, -1.0, step_s) + 0.125).abs() < 1e-12,
            "{step_s}"
        );
    }
}

proptest! {
    #[test]
    fn the_way_is_the_integral_of_the_speed(
        speed in -1.0..2.0, setpoint in -3.0..3.0, terrain in 0.0..3.0, step in 0.01..2.0,
    ) {
        let driven = ROVER.step(speed, motion(setpoint, 0.0), terrain, step);
        let (parts, mut now, mut way) = (20_000, speed, 0.0);
        let target = setpoint.clamp(-terrain, 2.0 * terrain);
        let part_s = step / f64::from(parts);
        for _ in 0..parts {
            let next = now + (target - now).clamp(-4.0 * part_s, 4.0 * part_s);
            way += f64::midpoint(now, next) * part_s;
            now = next;
        }
        prop_assert!((driven.speed_m_s - now).abs() < 1e-9);
        prop_assert!((driven.length_m - way).abs() < 1e-6, "{} {way}", driven.length_m);
    }

    #[test]
    fn a_drive_keeps_its_limits_whatever_is_wanted(
        speed: f64, turn: f64, now in -1.0..2.0, step in 0.001..10.0,
    ) {
        let driven = ROVER.step(now, motion(speed, turn), 1.0, step);
        prop_assert!((-1.0..=2.0).contains(&driven.speed_m_s));
        prop_assert!((driven.speed_m_s - now).abs() <= 4.0 * step + 1e-12);
        prop_assert!(driven.turn_rate_rad_s.abs() <= 1.5);
        prop_assert!((-step..=2.0 * step).contains(&driven.length_m));
    }
}

#[test]
fn without_a_limit_speed_changes_at_once() {
    let drive = Drive {
        max_acceleration_m_s2: f64::INFINITY,
        ..ROVER
    };
    let driven = drive.step(-1.0, motion(2.0, 0.5), 1.0, 0.1);
    assert_eq!(driven.speed_m_s, 2.0);
    assert_eq!(driven.length_m, 2.0 * 0.1);
    assert_eq!(driven.turn_rate_rad_s, 0.5);
}

#[test]
fn nothing_that_is_not_a_number_is_wanted() {
    let nan = motion(f64::NAN, f64::NAN);
    let driven = ROVER.step(0.0, nan, 1.0, 0.1);
    assert_eq!((driven.length_m, driven.turn_rad), (0.0, 0.0));
    assert_eq!(driven.motion(), Motion::default());
    let infinite = motion(f64::NEG_INFINITY, f64::INFINITY);
    let driven = ROVER.step(-1.0, infinite, 1.0, 0.1);
    assert_eq!((driven.speed_m_s, driven.turn_rate_rad_s), (-1.0, 1.5));
}

/// A drive with errors, of a robot that accelerates as fast as it likes unless the spec limits it.
fn drive_of(more: DriveSpec) -> Drive {
    Drive::new(&more, 0.25, 0.1)
}

fn exact_spec() -> DriveSpec {
    DriveSpec {
        max_speed_m_s: 2.0,
        max_reverse_speed_m_s: 1.0,
        max_acceleration_m_s2: None,
        max_turn_rate_deg_s: Some(90.0),
        lag_s: 0.0,
        delay_s: 0.0,
        gain: 1.0,
        gain_left_right: 1.0,
        track_width_m: None,
        odometry: None,
    }
}

#[test]
fn a_drive_measures_its_motion_unless_it_has_errors_or_a_scenario_decides() {
    assert!(drive_of(exact_spec()).has_odometry);
    assert_eq!(drive_of(exact_spec()).errors, None);
    let with = [
        DriveSpec {
            lag_s: 0.1,
            ..exact_spec()
        },
        DriveSpec {
            delay_s: 0.1,
            ..exact_spec()
        },
        DriveSpec {
            gain: 0.9,
            ..exact_spec()
        },
        DriveSpec {
            gain_left_right: 1.1,
            ..exact_spec()
        },
    ];
    for spec in with {
        assert!(!drive_of(spec).has_odometry, "{spec:?}");
        let odometry = Some(true);
        assert!(drive_of(DriveSpec { odometry, ..spec }).has_odometry);
    }
    let odometry = Some(false);
    assert!(
        !drive_of(DriveSpec {
            odometry,
            ..exact_spec()
        })
        .has_odometry
    );
}

#[test]
fn only_a_drive_without_lag_turns_at_once() {
    let at_once = DriveSpec {
        max_turn_rate_deg_s: None,
        ..exact_spec()
    };
    assert!(drive_of(at_once).turns_at_once);
    assert!(
        drive_of(DriveSpec {
            gain: 1.1,
            ..at_once
        })
        .turns_at_once
    );
    assert!(
        !drive_of(DriveSpec {
            lag_s: 0.1,
            ..at_once
        })
        .turns_at_once
    );
}

proptest! {
    #[test]
    fn a_drive_with_errors_keeps_its_executed_limits(
        speeds: [f64; 2], turns: [f64; 2], gains in (0.0..2.0, 0.1..10.0), times in (0.0..1.0, 0.0..1.0),
        acceleration in 0.1..9.0,
    ) {
        let drive = drive_of(DriveSpec {
            gain: gains.0,
            gain_left_right: gains.1,
            lag_s: times.0,
            delay_s: times.1,
            max_acceleration_m_s2: Some(acceleration),
            ..exact_spec()
        });
        let errors = drive.errors.unwrap();
        let setpoints = [0, 1].map(|place| motion(speeds[place], turns[place]));
        let mut now = Motion::default();
        for _ in 0..20 {
            let driven = drive.step_with_errors(&errors, now, setpoints, (1.0, 0.1));
            prop_assert!(driven.speed_m_s.abs() <= drive.fastest_m_s() + 1e-9);
            prop_assert!(driven.length_m.abs() <= drive.fastest_m_s() * 0.1 + 1e-9);
            prop_assert!(driven.turn_rate_rad_s.abs() <= drive.fastest_turn_rad_s() + 1e-9);
            prop_assert!((driven.speed_m_s - now.speed_m_s).abs() <= acceleration * 0.1 + 3e-6);
            now = motion(driven.speed_m_s, driven.turn_rate_rad_s);
            prop_assert_eq!(drive.executable(now, 1.0), now);
        }
    }

    #[test]
    fn without_errors_a_drive_with_errors_is_exact(
        speed: f64, turn: f64, now in -1.0..2.0, terrain in 0.1..3.0,
    ) {
        let drive = drive_of(exact_spec());
        let errors = DriveErrors::new(&exact_spec(), 0.25, 0.1);
        let setpoint = motion(speed, turn);
        let state = motion(now, 0.0);
        let with = drive.step_with_errors(&errors, state, [setpoint; 2], (terrain, 0.1));
        prop_assert_eq!(with, drive.step(now, setpoint, terrain, 0.1));
    }
}
