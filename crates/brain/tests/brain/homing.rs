//! Returning home in a brain without a simulator, for correct and wrong battery readings.

use crate::{body, percept_at};
use brain::{Brain, Percept, Reading};

/// A brain with a waypoint in the east and its base in the west.
fn brain() -> Brain {
    let spec = r#"{
        "arbitration": {"kind": "goals"}, "limit_speed_to_stopping_distance": false,
        "behaviours": [
            {"kind": "navigate", "waypoints_m": [[45, 0]]},
            {"kind": "return_home", "at_m": [-9, 0]}
        ]
    }"#;
    crate::brain(spec, body())
}

/// Whether it returns home after one more reading.
fn goes_home(brain: &mut Brain, left: f64, age_s: f64) -> bool {
    brain.step(&Percept {
        battery: Some(Reading { value: left, age_s }),
        ..percept_at(0.0, 0.0, 0.0)
    });
    let goals = brain.belief_state().unwrap().goals;
    goals.iter().any(|goal| goal.behaviour == 1)
}

/// The same after a number of equal readings.
fn goes_home_after(brain: &mut Brain, readings: u32, left: f64) -> bool {
    (0..readings).fold(false, |_, _| goes_home(brain, left, 0.0))
}

#[test]
fn a_single_low_reading_does_not_trigger_a_return_even_if_it_is_the_first() {
    let bad = [
        (-5.0, 0.0),
        (f64::NAN, 0.0),
        (0.0, 1e6),
        (0.0, -1.0),
        (0.0, 0.0),
    ];
    for (left, age_s) in bad {
        for good in [0, 50] {
            let mut brain = brain();
            goes_home_after(&mut brain, good, 0.9);
            assert!(!goes_home(&mut brain, left, age_s), "{left} {age_s}");
            for _ in 0..50 {
                assert!(!goes_home(&mut brain, 0.9, 0.0), "{left} {age_s}");
            }
        }
    }
}

#[test]
fn invalid_readings_never_trigger_a_return() {
    for (left, age_s) in [(-5.0, 0.0), (2.0, 0.0), (0.0, 1e6), (f64::NAN, 0.0)] {
        let mut brain = brain();
        goes_home_after(&mut brain, 50, 0.9);
        let goes = (0..50).any(|_| goes_home(&mut brain, left, age_s));
        assert!(!goes, "{left} {age_s}");
    }
}

#[test]
fn two_low_readings_trigger_a_return_until_the_battery_is_charged() {
    let mut brain = brain();
    assert!(!goes_home_after(&mut brain, 50, 0.9));
    assert!(!goes_home(&mut brain, 0.09, 0.0));
    assert!(goes_home(&mut brain, 0.09, 0.0));
    // A noisy gauge, or the start of charging.
    assert!(goes_home_after(&mut brain, 50, 0.15));
    assert!(!goes_home_after(&mut brain, 2, 0.9));
    assert!(!goes_home_after(&mut brain, 100, 0.9));
}

#[test]
fn the_robot_recovers_from_a_gauge_that_was_stuck_at_zero() {
    let mut brain = brain();
    goes_home_after(&mut brain, 50, 0.9);
    assert!(goes_home_after(&mut brain, 5, 0.0));
    assert!(!goes_home_after(&mut brain, 2, 0.9));
    assert!(!goes_home_after(&mut brain, 100, 0.89));
}

#[test]
fn it_returns_while_the_battery_lasts_for_twice_the_path() {
    let mut brain = brain();
    // 0.02 per second: at 0.36 the battery lasts 18 s, twice the time for 9 m.
    let left = |step: u32| 1.0 - 0.002 * f64::from(step);
    let went = (0..500).find(|step| goes_home(&mut brain, left(*step), 0.0));
    let left = went.map(left);
    assert!(
        left.is_some_and(|left| (left - 0.36).abs() < 0.01),
        "{left:?}"
    );
}
