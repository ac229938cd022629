//! Random search follows the law of B. O. Koopman, *Search and Screening* (OEG Report 56, 1946).

use crate::paths::long_path_factor;
use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{
    Random, away, found, relative_sweep_width, robots, run, scenario, step, time_s, whole,
};
use base::document::Value;
use sim::simulation::Simulation;
use std::f64::consts::PI;

const TEXT: &str = include_str!("../../../../docs/validation/random-search.toml");
const BOUNCE: &str = include_str!("../../../../docs/validation/bounce.toml");
const AREA_M2: f64 = 2500.0;
const RANGE_M: f64 = 0.5;
const SPEED_M_S: f64 = 5.0;
const STEP_S: f64 = 0.1;
const BOUNCE_M_S: f64 = 2.0;
const ITEMS: f64 = 300.0;

/// Swept areas, with multiplicity and relative to the whole area, at which finds are evaluated.
const SWEPT: [f64; 7] = [0.125, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0];

/// Runs per team; their shares have a standard deviation of about 0.06, since finds are correlated.
const RUNS: u64 = 200;

/// The share of items found in a run, and its expected value.
#[derive(Clone, Copy)]
struct Found {
    share: f64,
    expected: f64,
}

/// One run, at each value of `SWEPT`.
type Search = [Found; SWEPT.len()];

/// Effective sweep width of a robot with one measurement per step.
fn width_m() -> f64 {
    2.0 * RANGE_M * relative_sweep_width(SPEED_M_S * STEP_S, RANGE_M)
}

/// Expected share found after a total distance of all robots: Koopman's law, with the areas visible
/// from the start positions and the correction for [long paths](long_path_factor).
fn koopman(robots: u32, driven_m: f64) -> f64 {
    let unseen = 1.0 - PI * RANGE_M * RANGE_M / AREA_M2;
    let unseen: f64 = (0..robots).map(|_| unseen).product();
    let rate = width_m() / AREA_M2 * long_path_factor(width_m() / AREA_M2.sqrt());
    1.0 - unseen * libm::exp(-rate * driven_m)
}

/// The searches of a team.
fn searches(robots: u32, range_m: f64) -> Vec<Search> {
    let changes = [
        ("robots.searcher.count", whole(robots)),
        ("robots.searcher.sensors.eye.range_m", Value::Float(range_m)),
    ];
    let scenario = scenario(TEXT, &changes);
    let search = |number: u64| {
        let mut simulation = run(&scenario, u64::from(robots), number);
        let mut random = Random::of_run(number);
        SWEPT.map(|swept| {
            let driven_m = sweep(&mut simulation, &mut random, swept * AREA_M2 / width_m());
            Found {
                share: f64::from(found(&simulation)) / ITEMS,
                expected: koopman(robots, driven_m),
            }
        })
    };
    (0..RUNS).map(search).collect()
}

/// Continues until measurements cover `min_m` of the total distance of all robots; returns the
/// distance covered.
fn sweep(simulation: &mut Simulation, random: &mut Random, min_m: f64) -> f64 {
    loop {
        let robots = robots(simulation);
        let driven_m: f64 = robots.iter().map(|robot| robot.distance_m).sum();
        let commands = away(&robots, simulation, 0.0, random);
        step(simulation, commands);
        // The measurement of this step was at the start position of the step.
        if driven_m >= min_m {
            return driven_m;
        }
    }
}

fn rows(series: &str, searches: &[Search]) -> Vec<Row> {
    let row = |(place, swept): (usize, &f64)| {
        let found = searches.iter().map(|search| search[place]);
        let expected: Vec<f64> = found.clone().map(|found| found.expected).collect();
        let shares: Vec<f64> = found.map(|found| found.share).collect();
        let expected = Row::mean("", 0.0, &expected, None).measured;
        Row::mean(series, *swept, &shares, Some(expected))
    };
    SWEPT.iter().enumerate().map(row).collect()
}

/// The share found by a robot with a body and the bundled brain, by the area that it would sweep at
/// full speed; there is no closed form for it.
fn bounce() -> Vec<Row> {
    let scenario = scenario(BOUNCE, &[]);
    let search = |number| {
        let mut simulation = run(&scenario, 3, number);
        SWEPT.map(|swept| {
            let last_s = swept * AREA_M2 / (2.0 * RANGE_M * BOUNCE_M_S);
            while time_s(&simulation) < last_s {
                simulation.step();
            }
            let share = f64::from(found(&simulation)) / ITEMS;
            Found {
                share,
                expected: f64::NAN,
            }
        })
    };
    let searches: Vec<Search> = (0..RUNS / 4).map(search).collect();
    let rows = rows("bundled brain", &searches);
    let unexpected = |row| Row {
        expected: None,
        ..row
    };
    rows.into_iter().map(unexpected).collect()
}

#[test]
fn random_search_follows_koopmans_law_for_any_number_of_robots() {
    let teams = [(1, "1 robot"), (4, "4 robots"), (16, "16 robots")];
    let teams = teams.map(|(robots, series)| (series, searches(robots, RANGE_M)));
    let each = teams.iter();
    let mut all: Vec<Row> = each
        .flat_map(|(series, searches)| rows(series, searches))
        .collect();
    all.extend(rows("all", &teams.map(|(_, searches)| searches).concat()));
    assert_right(&all);
    let bundled = bounce();
    // A version that braked too late to turn followed the walls, and found only 0.03.
    assert!(bundled[SWEPT.len() - 1].measured > 0.5, "{bundled:#?}");
    all.extend(bundled);
    assert_published("random-search.csv", &all);
}

#[test]
fn a_sweep_width_5_percent_off_is_detected() {
    let searches = [1, 4, 16].map(|robots| searches(robots, 0.95 * RANGE_M));
    assert_wrong(&rows("all", &searches.concat()));
}
