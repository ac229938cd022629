//! With lanes as wide as the sweep, finds are proportional to time: nothing is observed twice.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{first_of, found, relative_sweep_width, run, scenario, step, turning};
use base::document::Value;
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

const TEXT: &str = include_str!("../../../../docs/validation/lanes.toml");
const RANGE_M: f64 = 0.5;
const STEP_S: f64 = 0.1;
const ITEMS: u32 = 1000;
const RUNS: u64 = 20;
const LANES: u32 = 20;

/// A lane of 40 m that starts and ends 5 cm from the walls, in metres and in steps of 0.1 m.
const LANE_M: f64 = 39.9;
const LANE_STEPS: u32 = 399;

/// Items found in a run after each lane.
fn mow(range_m: f64, number: u64) -> Vec<u32> {
    let range = ("robots.mower.sensors.eye.range_m", Value::Float(range_m));
    let scenario = scenario(TEXT, &[range]);
    let mut simulation = run(&scenario, 1, number);
    let mow = |lane: u32| {
        ahead(&mut simulation, LANE_STEPS);
        // One more measurement at the end of the lane, and a turn into the next one.
        let turn_rad = if lane.is_multiple_of(2) {
            FRAC_PI_2
        } else {
            -FRAC_PI_2
        };
        turn(&mut simulation, turn_rad);
        let found = found(&simulation);
        ahead(&mut simulation, 10);
        turn(&mut simulation, turn_rad);
        found
    };
    (0..LANES).map(mow).collect()
}

fn ahead(simulation: &mut Simulation, steps: u32) {
    for _ in 0..steps {
        simulation.step();
    }
}

fn turn(simulation: &mut Simulation, by_rad: f64) {
    let command = turning(by_rad, STEP_S);
    step(simulation, BTreeMap::from([(first_of(0), command)]));
}

fn rows(range_m: f64) -> Vec<Row> {
    let runs: Vec<Vec<u32>> = (0..RUNS).map(|number| mow(range_m, number)).collect();
    let all = ITEMS * u32::try_from(RUNS).unwrap();
    // Between measurements 0.1 m apart, a small area at the edge of a lane is not observed.
    let seen = relative_sweep_width(0.1, RANGE_M);
    let row = |(lane, done): (usize, u32)| {
        let found = runs.iter().map(|run| run[lane]).sum();
        let swept = f64::from(done) / f64::from(LANES);
        Row::share("lanes", f64::from(done) * LANE_M, found, all, seen * swept)
    };
    (1..=LANES)
        .enumerate()
        .map(|(lane, done)| row((lane, done)))
        .collect()
}

#[test]
fn finds_are_proportional_to_the_distance_driven() {
    let rows = rows(RANGE_M);
    assert_published("lanes.csv", &rows);
    assert_right(&rows);
}

#[test]
fn a_sweep_5_percent_narrower_is_detected() {
    assert_wrong(&rows(0.95 * RANGE_M));
}
