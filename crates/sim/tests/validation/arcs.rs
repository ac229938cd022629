//! A constant speed and turn rate give a circle, up to rounding errors.

use crate::rows::{Row, assert_published};
use crate::setup::{first_of, moving, only, run, scenario};
use base::geometry::Point;
use base::trig::sin_cos;
use std::collections::BTreeMap;

const TEXT: &str = include_str!("../../../../docs/validation/motion.toml");
const START: Point = Point { x: 50.0, y: 50.0 };
const STEP_S: f64 = 0.1;

/// Bound on the rounding error of the position after 100,000 steps, in metres.
const MAX_ERROR_M: f64 = 1e-9;

/// Steps after which the position is compared.
const STEPS: [u32; 6] = [1, 10, 100, 1_000, 10_000, 100_000];

/// Speed in m/s, turn rate in rad/s, and a name.
const ARCS: [(&str, f64, f64); 3] = [
    ("radius 0.5 m", 1.0, 2.0),
    ("radius 5 m", 2.0, -0.4),
    ("radius 20 m", 4.0, 0.2),
];

/// The position on the circle after a time.
fn on_circle(speed_m_s: f64, turn_rate_rad_s: f64, time_s: f64) -> Point {
    let angle_rad = turn_rate_rad_s * time_s;
    let radius_m = speed_m_s / turn_rate_rad_s;
    START.plus(Point {
        x: radius_m * libm::sin(angle_rad),
        y: radius_m * (1.0 - libm::cos(angle_rad)),
    })
}

/// Distances of the simulated body from the exact position.
fn simulated(speed_m_s: f64, turn_rate_rad_s: f64) -> Vec<f64> {
    let mut simulation = run(&scenario(TEXT, &[]), 1, 0);
    let command = moving(speed_m_s, turn_rate_rad_s);
    let mut done = 0;
    let off_m = STEPS.map(|steps| {
        for _ in done..steps {
            let commands = BTreeMap::from([(first_of(0), command.clone())]);
            simulation.step_with(BTreeMap::new(), commands).unwrap();
        }
        done = steps;
        let time_s = f64::from(steps) * STEP_S;
        let circle = on_circle(speed_m_s, turn_rate_rad_s, time_s);
        circle.to(only(&simulation).at).length()
    });
    off_m.to_vec()
}

/// The same for a body that drives straight in each step (Euler's method): a wrong simulator.
fn euler(speed_m_s: f64, turn_rate_rad_s: f64) -> Vec<f64> {
    let (mut at, mut done) = (START, 0);
    let off_m = STEPS.map(|steps| {
        for number in done..steps {
            let (y, x) = sin_cos(turn_rate_rad_s * f64::from(number) * STEP_S);
            at = at.plus(Point { x, y }.times(speed_m_s * STEP_S));
        }
        done = steps;
        on_circle(speed_m_s, turn_rate_rad_s, f64::from(steps) * STEP_S)
            .to(at)
            .length()
    });
    off_m.to_vec()
}

fn rows(name: &str, off_m: Vec<f64>) -> Vec<Row> {
    let steps = STEPS.iter().zip(off_m);
    let row = |(steps, off_m): (&u32, f64)| Row {
        expected: None,
        ..Row::exact(name, f64::from(*steps), off_m, 0.0)
    };
    steps.map(row).collect()
}

#[test]
fn a_body_stays_on_its_circle_for_100_000_steps() {
    let arcs = ARCS.iter();
    let off = arcs.flat_map(|(name, speed, turn)| rows(name, simulated(*speed, *turn)));
    let mut off: Vec<Row> = off.collect();
    let worst_m = off.iter().map(|row| row.measured).fold(0.0, f64::max);
    let (_, speed, turn) = ARCS[1];
    off.extend(rows("radius 5 m by Euler's method", euler(speed, turn)));
    assert_published("arcs.csv", &off);
    assert!(worst_m < MAX_ERROR_M, "{off:#?}");
}

#[test]
fn eulers_method_leaves_the_circle_in_the_first_steps() {
    for (_, speed, turn) in ARCS {
        assert!(euler(speed, turn)[1] > 1e6 * MAX_ERROR_M);
    }
}
