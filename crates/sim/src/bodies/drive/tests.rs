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
    assert_eq!(ROVER.step(0.0, nan, 1.0, 0.1), Driven::REST);
    let infinite = motion(f64::NEG_INFINITY, f64::INFINITY);
    let driven = ROVER.step(-1.0, infinite, 1.0, 0.1);
    assert_eq!((driven.speed_m_s, driven.turn_rate_rad_s), (-1.0, 1.5));
}
