//! If nothing is found in n fair samples, the share of mined cells is at most 1 - alpha^(1/n), with
//! confidence 1 - alpha.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{found, list, places, run, scenario, whole};
use base::document::Value;
use base::geometry::Point;
use rayon::prelude::*;
use std::f64::consts::PI;

const TEXT: &str = include_str!("../../../../docs/validation/samples.toml");
const RANGE_M: f64 = 0.5;
const MINES: u32 = 100;
const ALPHA: f64 = 0.05;

/// Numbers of sampled cells, in rows of 10.
const SAMPLES: [u32; 3] = [10, 30, 60];

/// The standard error of a probability of 0.05 is 0.0034.
const RUNS: u64 = 4000;

/// Largest share of mined cells, when none of the sampled cells is mined.
fn bound(samples: u32) -> f64 {
    1.0 - ALPHA.powf(1.0 / f64::from(samples))
}

/// Side of the square in which a cell is mined with a probability: its number of mines has a Poisson
/// distribution with the mean density times area.
fn side_m(mined: f64) -> f64 {
    let per_m2 = -(1.0 - mined).ln() / (PI * RANGE_M * RANGE_M);
    (f64::from(MINES) / per_m2).sqrt()
}

fn cells(samples: u32) -> Value {
    let cell = |sample: u32| Point {
        x: 1.0 + f64::from(sample % 10),
        y: 1.0 + f64::from(sample / 10),
    };
    places((0..samples).map(cell))
}

/// The share of fields at the bound in which no sample finds a mine.
fn row(samples: u32, detection: f64) -> Row {
    let side = || Value::Float(side_m(bound(samples)));
    let changes = [
        ("world.size_m", list([side(), side()])),
        ("robots.sampler.count", whole(samples)),
        ("robots.sampler.start.kind", Value::Text("fixed".into())),
        ("robots.sampler.start.at_m", cells(samples)),
        (
            "robots.sampler.sensors.eye.detection_probability.mine",
            Value::Float(detection),
        ),
    ];
    let scenario = scenario(TEXT, &changes);
    let is_clean = |number: &u64| {
        let mut simulation = run(&scenario, 1, *number);
        simulation.step();
        found(&simulation) == 0
    };
    let clean = (0..RUNS).into_par_iter().filter(is_clean).count();
    let [clean, runs] = [clean as u64, RUNS].map(|number| u32::try_from(number).unwrap());
    Row::share(
        "no mine in n samples",
        f64::from(samples),
        clean,
        runs,
        ALPHA,
    )
}

#[test]
fn at_the_bound_no_mine_is_found_with_probability_alpha() {
    let rows = SAMPLES.map(|samples| row(samples, 1.0));
    assert_published("samples.csv", &rows);
    assert_right(&rows);
}

/// The wrong model: samples of a sensor that misses count as those of a perfect one.
#[test]
fn a_sensor_that_misses_a_fifth_is_detected() {
    assert_wrong(&SAMPLES.map(|samples| row(samples, 0.8)));
}
