//! With a Poisson prior, the number of mines left does not depend on the number found.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{run, scenario};
use base::document::Value;
use rayon::prelude::*;

const TEXT: &str = include_str!("../../../../docs/validation/mines-left.toml");

/// Mean number of mines, probability of detection per look, and blind share.
const MINES: f64 = 8.0;
const DETECTION: f64 = 0.5;
const BLIND: f64 = 0.1;

const LOOKS: i32 = 2;
const RUNS: u64 = 40_000;

/// Larger numbers of mines left are grouped.
const MANY: u32 = 7;

/// Mines found and left in a run.
type Search = [u32; 2];

/// Expected share that is found: 0.675.
fn clearance() -> f64 {
    (1.0 - BLIND) * (1.0 - (1.0 - DETECTION).powi(LOOKS))
}

fn searches(number: &str) -> Vec<Search> {
    let changes = [("items.mine.number", Value::Text(number.into()))];
    let scenario = scenario(TEXT, &changes);
    let search = |number| {
        let mut simulation = run(&scenario, 1, number);
        (0..LOOKS).for_each(|_| simulation.step());
        let outcome = simulation.outcome();
        [outcome.found[0], outcome.missed[0]]
    };
    (0..RUNS).into_par_iter().map(search).collect()
}

/// Numbers of mines left in the runs with few, usual and many finds.
fn groups(searches: &[Search]) -> [(&'static str, Vec<u32>); 3] {
    let left = |least: u32, most: u32| {
        let some = searches
            .iter()
            .filter(|[found, _]| (least..=most).contains(found));
        some.map(|[_, left]| *left).collect()
    };
    [
        ("0 to 3 found", left(0, 3)),
        ("4 to 7 found", left(4, 7)),
        ("8 or more found", left(8, u32::MAX)),
    ]
}

/// Probabilities of 0, 1, ... and of `MANY` or more.
fn poisson(mean: f64) -> Vec<f64> {
    let mut left = 1.0;
    let mut probability = (-mean).exp();
    let mut all = Vec::new();
    for count in 1..=MANY {
        all.push(probability);
        left -= probability;
        probability *= mean / f64::from(count);
    }
    all.push(left);
    all
}

/// The share of runs with each number of mines left, by the number found.
fn shares(searches: &[Search]) -> Vec<Row> {
    let of_group = |(series, left): (&str, Vec<u32>)| {
        let runs = u32::try_from(left.len()).unwrap();
        let row = |(number, probability): (u32, f64)| {
            let here = left.iter().filter(|left| (**left).min(MANY) == number);
            let here = u32::try_from(here.count()).unwrap();
            Row::share(series, f64::from(number), here, runs, probability)
        };
        let expected = poisson(MINES * (1.0 - clearance()));
        (0..).zip(expected).map(row).collect::<Vec<_>>()
    };
    groups(searches).into_iter().flat_map(of_group).collect()
}

/// The mean number of mines left for each number found, and what `law` expects.
fn means(searches: &[Search], law: impl Fn(f64) -> f64) -> Vec<Row> {
    let row = |found: u32| {
        let here = searches.iter().filter(|search| search[0] == found);
        let left: Vec<f64> = here.map(|[_, left]| f64::from(*left)).collect();
        let found = f64::from(found);
        Row::mean("mean number left", found, &left, Some(law(found)))
    };
    (1..=12).map(row).collect()
}

/// A group has at least 7,000 runs, so that the standard error of a probability of 0.074 is at most 0.0031.
#[test]
fn the_number_of_mines_left_is_poisson_whatever_was_found() {
    let searches = searches("poisson");
    let left = MINES * (1.0 - clearance());
    let all = [shares(&searches), means(&searches, |_| left)].concat();
    assert_published("mines-left.csv", &all);
    assert_right(&all);
    assert!(groups(&searches).iter().all(|(_, left)| left.len() > 7000));
}

/// The wrong model is a flat prior: (n + 1) (1 - P) / P mines are left if n were found.
#[test]
fn the_numbers_left_are_not_those_of_a_flat_prior() {
    let flat = |found: f64| (found + 1.0) * (1.0 - clearance()) / clearance();
    assert_wrong(&means(&searches("poisson"), flat));
}

/// The wrong model is a lane that always has eight mines.
#[test]
fn a_fixed_number_of_mines_is_detected() {
    assert_wrong(&shares(&searches("fixed")));
}
