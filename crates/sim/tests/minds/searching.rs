//! What it buys to know where one has looked, and to tell.

use crate::scenario;
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::sync::Arc;

/// The shipped scenario.
const SEARCH: &str = include_str!("../../../../scenarios/search.toml");

/// A search that takes longer has taken so long.
const CAP_S: f64 = 600.0;

const RUNS: u64 = 120;

/// With radio some searches of `frontier` end long after all others, so that it takes more to tell.
const FRONTIER_RUNS: u64 = 400;

fn text(behaviours: &str, more: &str) -> String {
    let of_brain = "[robots.rover.brain]\n";
    assert!(SEARCH.contains(of_brain) && SEARCH.contains("time_limit_s = 120"));
    SEARCH
        .replace("time_limit_s = 120", &format!("time_limit_s = {CAP_S}"))
        .replace(
            of_brain,
            &format!("{more}\n{of_brain}behaviours = [{behaviours}]\n"),
        )
}

/// When each of the same worlds was searched, in seconds.
fn times_s(behaviours: &str, more: &str, runs: u64) -> Vec<f64> {
    let scenario = scenario(&text(behaviours, more));
    let time_s = |run| {
        let mut simulation = Simulation::new(Arc::clone(&scenario), 1, run).unwrap();
        simulation.finish();
        simulation.outcome().time_s.min(CAP_S)
    };
    (0..runs).into_par_iter().map(time_s).collect()
}

/// The mean of paired differences, and its standard error.
fn sooner_s(slow: &[f64], fast: &[f64]) -> (f64, f64) {
    #[expect(clippy::cast_precision_loss, reason = "few")]
    let count = slow.len() as f64;
    let differences: Vec<f64> = slow
        .iter()
        .zip(fast)
        .map(|(slow, fast)| slow - fast)
        .collect();
    let mean = differences.iter().sum::<f64>() / count;
    let squares: f64 = differences
        .iter()
        .map(|each| (each - mean) * (each - mean))
        .sum();
    (mean, (squares / (count - 1.0) / count).sqrt())
}

/// With a chance of error of one in a thousand.
fn assert_sooner(slow: &[f64], fast: &[f64]) {
    let (mean, error) = sooner_s(slow, fast);
    assert!(mean > 3.1 * error, "{mean} s sooner, give or take {error}");
}

const BOUNCE: &str = "{ kind = \"cruise\" }, { kind = \"random_bounce\" }, { kind = \"avoid\" }";
const SILENT: &str = "[robots.rover.radio]\nrange_m = 0\n";

#[test]
fn who_knows_where_it_has_looked_and_tells_finds_sooner_than_who_bounces() {
    let bounces = times_s(BOUNCE, "", RUNS);
    for kind in ["frontier", "bayesian_search"] {
        let behaviours = format!("{{ kind = \"{kind}\" }}, {{ kind = \"avoid\" }}");
        assert_sooner(&bounces, &times_s(&behaviours, "", RUNS));
    }
}

#[test]
fn four_that_tell_each_other_where_they_look_find_sooner_than_four_that_do_not() {
    for (kind, runs) in [("frontier", FRONTIER_RUNS), ("bayesian_search", RUNS)] {
        let behaviours = format!("{{ kind = \"{kind}\" }}, {{ kind = \"avoid\" }}");
        let silent = times_s(&behaviours, SILENT, runs);
        assert_sooner(&silent, &times_s(&behaviours, "", runs));
    }
}
