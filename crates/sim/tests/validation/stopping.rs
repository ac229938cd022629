//! A body stops within v^2 / 2a, so that a robot that limits its speed to its stopping distance
//! never collides with a wall.

use crate::rows::{Row, assert_published};
use crate::setup::{first_of, moving, only, places, run, scenario};
use base::document::Value;
use base::geometry::Point;
use std::collections::BTreeMap;

const MOTION: &str = include_str!("../../../../docs/validation/motion.toml");
const SIGHT: &str = include_str!("../../../../docs/validation/sight.toml");
const ACCELERATION: &str = "robots.body.drive.max_acceleration_m_s2";

/// Gap between the robot of `sight.toml` and the wall at the start, and its braking deceleration.
const WALL_M: f64 = 40.0;
const RADIUS_M: f64 = 0.25;
const BRAKES_M_S2: f64 = 1.5;

/// Tolerance for rounding errors.
const HAIR: f64 = 1e-9;

/// Accelerates a body to a speed, commands it to stop, and returns its stopping distance.
fn stopping_m(speed_m_s: f64, brakes_m_s2: f64) -> f64 {
    let start = places([Point { x: 10.0, y: 50.0 }]);
    let changes = [
        (ACCELERATION, Value::Float(brakes_m_s2)),
        ("robots.body.start.at_m", start),
    ];
    let mut simulation = run(&scenario(MOTION, &changes), 1, 0);
    let mut want = |speed_m_s, steps| {
        for _ in 0..steps {
            let commands = BTreeMap::from([(first_of(0), moving(speed_m_s, 0.0))]);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
        }
        only(&simulation).distance_m
    };
    // Longer than accelerating from 0 to 5 m/s takes with the lowest limit.
    let before_m = want(speed_m_s, 110);
    want(0.0, 110) - before_m
}

fn distances() -> Vec<Row> {
    let brakes = [0.5, 1.0, 4.0];
    let speeds = [0.33, 1.0, 1.7, 2.5, 3.3, 4.2, 5.0];
    let all = brakes
        .iter()
        .flat_map(|brakes| speeds.map(|speed| (*brakes, speed)));
    let rows = all.map(|(brakes, speed)| {
        let series = format!("{brakes} m/s²");
        let expected = speed * speed / (2.0 * brakes);
        Row::exact(&series, speed, stopping_m(speed, brakes), expected)
    });
    rows.collect()
}

#[test]
fn a_body_stops_within_its_squared_speed_divided_by_twice_its_deceleration() {
    let rows = distances();
    assert_published("stopping.csv", &rows);
    for row in &rows {
        let expected = row.expected.unwrap();
        assert!((row.measured - expected).abs() < HAIR * expected, "{row:?}");
        // Euler's method would overshoot by half a step at full speed.
        assert!(row.x * 0.1 / 2.0 > 1e6 * HAIR * expected);
    }
}

/// Gap to the wall and speed in each step of a robot that drives towards a wall.
fn approach(changes: &[(&str, Value)]) -> Vec<(f64, f64)> {
    let mut simulation = run(&scenario(SIGHT, changes), 1, 0);
    let steps = 0..400;
    let states = steps.map(|_| {
        simulation.step();
        let robot = only(&simulation);
        (WALL_M - RADIUS_M - robot.at.x, robot.speed_m_s)
    });
    states.collect()
}

/// Whether the stopping distance exceeds the distance to the nearer of the wall and its ray range.
fn needs_more_than_it_has((gap_m, speed_m_s): &(f64, f64)) -> bool {
    let seen_m = gap_m.min(8.0 - RADIUS_M);
    speed_m_s * speed_m_s / (2.0 * BRAKES_M_S2) > seen_m + HAIR
}

#[test]
fn a_robot_that_limits_its_speed_to_the_stopping_distance_always_stops_before_a_wall() {
    let states = approach(&[]);
    let every_third = states.iter().step_by(3);
    let rows = every_third.map(|(gap_m, speed_m_s)| Row {
        error: 0.0,
        ..Row::exact(
            "towards a wall",
            *gap_m,
            *speed_m_s,
            (2.0 * BRAKES_M_S2 * gap_m.clamp(0.0, 8.0 - RADIUS_M)).sqrt(),
        )
    });
    let rows: Vec<Row> = rows.collect();
    assert_published("sight.csv", &rows);
    assert!(!states.iter().any(needs_more_than_it_has));
    let fastest = states.iter().map(|(_, speed)| *speed).fold(0.0, f64::max);
    assert!(fastest > 4.0, "it reaches a high speed");
}

#[test]
fn a_robot_without_the_limit_does_not_always_stop_before_a_wall() {
    let careless = (
        "robots.rover.brain.limit_speed_to_stopping_distance",
        Value::Bool(false),
    );
    assert!(approach(&[careless]).iter().any(needs_more_than_it_has));
}
