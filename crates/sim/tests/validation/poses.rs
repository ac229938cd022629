//! Believed poses are calibrated, also with late readings: the position is within three stated
//! deviations with probability 1 - exp(-9/2) = .989 (two dimensions), the heading with .997 (one).

use crate::rows::{Row, assert_published};
use crate::setup::{Random, robots, run, scenario, whole};
use base::document::Value;
use base::trig::wrapped;
use rayon::prelude::*;
use sim::simulation::Simulation;

const TEXT: &str = include_str!("../../../../docs/validation/calibration.toml");

/// Runs per delay, of three robots each.
const RUNS: u64 = 8;
/// Runs with random sensors.
const MIXES: u64 = 64;

/// Steps of a run, and those before the first evaluation.
const STEPS: usize = 400;
const WARM_UP: usize = 50;

const DELAYS_S: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

/// Minimum shares of positions and headings: 0.02 below those of Gaussian errors.
const MIN_SHARES: [f64; 2] = [0.969, 0.977];

/// Rounding tolerance where an exact sensor leaves a deviation of 0.
const ROUNDING: f64 = 1e-9;

type Changes = Vec<(String, Value)>;

fn sensor(name: &str, key: &str, value: f64) -> (String, Value) {
    let path = format!("robots.rover.sensors.{name}.{key}");
    (path, Value::Float(value))
}

/// Whether position and heading of each robot with a pose are within three stated deviations after
/// the step.
fn evaluated(simulation: &mut Simulation) -> Vec<[f64; 2]> {
    let truth = robots(simulation);
    simulation.step();
    let within = truth.into_iter().filter_map(|robot| {
        let pose = simulation.state().belief_state(robot.id)?.pose?;
        let off_m = robot.at.to(pose.at).length();
        let off_rad = wrapped(pose.heading_rad - robot.heading_rad).abs();
        let deviations = [(off_m, pose.deviation_m), (off_rad, pose.deviation_rad)];
        Some(
            deviations
                .map(|(off, deviation)| f64::from(u8::from(off <= 3.0 * deviation + ROUNDING))),
        )
    });
    within.collect()
}

/// The shares of positions and headings within three stated deviations in a run.
fn shares(changes: &Changes, number: u64) -> [f64; 2] {
    let mut each = vec![("robots.rover.brain.rate_hz", whole(10))];
    each.extend(
        changes
            .iter()
            .map(|(path, value)| (path.as_str(), value.clone())),
    );
    let mut simulation = run(&scenario(TEXT, &each), 1, number);
    (0..WARM_UP).for_each(|_| simulation.step());
    let all: Vec<[f64; 2]> = (WARM_UP..STEPS)
        .flat_map(|_| evaluated(&mut simulation))
        .collect();
    let count: f64 = all.iter().map(|_| 1.0).sum();
    [0, 1].map(|place| all.iter().map(|within| within[place]).sum::<f64>() / count)
}

/// The mean shares over runs, which are independent.
fn rows(series: &str, x: f64, runs: &[[f64; 2]]) -> [Row; 2] {
    let names = ["position", "heading"];
    [0, 1].map(|place| {
        let each: Vec<f64> = runs.iter().map(|shares| shares[place]).collect();
        Row::mean(&format!("{series}: {}", names[place]), x, &each, None)
    })
}

/// Random delays, rates, dropouts and noise of both sensors.
fn mixed(number: u64) -> Changes {
    let mut random = Random::of_run(number);
    let mut any = |values: &[f64]| {
        let share_each = 1.0 / values.iter().map(|_| 1.0).sum::<f64>();
        let drawn = random.unit();
        let mut shares = values.iter().zip(1_u8..);
        let found = shares.find(|(_, number)| drawn < share_each * f64::from(*number));
        found.map_or(values[0], |(value, _)| *value)
    };
    let mut changes = Vec::new();
    for (name, noise, levels) in [
        ("gps", "noise_m", [0.0, 0.05, 0.5]),
        ("compass", "noise_deg", [0.0, 0.5, 5.0]),
    ] {
        changes.extend([
            sensor(name, "latency_s", any(&[0.0, 0.1, 0.3, 0.7, 1.0, 1.5, 2.0])),
            sensor(name, "rate_hz", any(&[1.0, 2.0, 5.0, 10.0])),
            sensor(name, "dropout_probability", any(&[0.0, 0.3, 0.7])),
            sensor(name, noise, any(&levels)),
        ]);
    }
    changes
}

/// The standard errors of the shares are below 0.004 and the shares above 0.99, so that a calibrated
/// brain fails with fewer than one seed in 10,000.
#[test]
fn late_readings_give_poses_within_their_stated_deviations() {
    let mut all = Vec::new();
    for (series, late) in [
        ("position sensor late", ["gps"].as_slice()),
        ("compass late", &["compass"]),
        ("both late", &["gps", "compass"]),
    ] {
        for delay_s in DELAYS_S {
            let changes: Changes = late
                .iter()
                .map(|name| sensor(name, "latency_s", delay_s))
                .collect();
            let runs: Vec<[f64; 2]> = (0..RUNS)
                .into_par_iter()
                .map(|number| shares(&changes, number))
                .collect();
            all.extend(rows(series, delay_s, &runs));
        }
    }
    let mixes: Vec<[f64; 2]> = (0..MIXES)
        .into_par_iter()
        .map(|number| shares(&mixed(number), number))
        .collect();
    all.extend(rows("random sensors", 2.0, &mixes));
    // Lines of the page: positions and headings of each series.
    all.sort_by(|one, other| one.series.cmp(&other.series));
    assert_published("poses.csv", &all);
    for row in &all {
        let min = MIN_SHARES[usize::from(row.series.ends_with("heading"))];
        assert!(row.measured >= min, "{row:?}");
    }
}
