//! The benefit of remembering searched areas, and of sharing them by radio.

use crate::scenarios::scenario;
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::sync::{Arc, LazyLock};

/// The bundled scenario.
const SEARCH: &str = include_str!("../../../../scenarios/search.toml");

/// The time limit of a search, which is also its duration if it takes longer.
const TIME_LIMIT_S: f64 = 600.0;

const RUNS: u64 = 120;

/// With radio some searches of `frontier` take much longer than the others, so that a significant
/// difference needs more runs.
const FRONTIER_RUNS: u64 = 400;

fn text(behaviours: &str, more: &str) -> String {
    let of_brain = "[robots.rover.brain]\n";
    assert!(SEARCH.contains(of_brain) && SEARCH.contains("time_limit_s = 120"));
    SEARCH
        .replace(
            "time_limit_s = 120",
            &format!("time_limit_s = {TIME_LIMIT_S}"),
        )
        .replace(
            of_brain,
            &format!("{more}\n{of_brain}behaviours = [{behaviours}]\n"),
        )
}

/// Durations in seconds of searches of the same worlds.
fn times_s(behaviours: &str, more: &str, runs: u64) -> Vec<f64> {
    let scenario = scenario(&text(behaviours, more));
    let time_s = |run| {
        let mut simulation = Simulation::new(Arc::clone(&scenario), 1, run).unwrap();
        simulation.finish().time_s.min(TIME_LIMIT_S)
    };
    (0..runs).into_par_iter().map(time_s).collect()
}

/// Durations with a behaviour that remembers the areas that were searched.
fn remembering_s(kind: &str, more: &str, runs: u64) -> Vec<f64> {
    let behaviours = format!("{{ kind = \"{kind}\" }}, {{ kind = \"avoid\" }}");
    times_s(&behaviours, more, runs)
}

/// The behaviours that remember, with durations for teams that share what they have searched.
static SHARING: LazyLock<[(&str, Vec<f64>); 2]> = LazyLock::new(|| {
    [("frontier", FRONTIER_RUNS), ("bayesian_search", RUNS)]
        .map(|(kind, runs)| (kind, remembering_s(kind, "", runs)))
});

/// The mean of paired differences and its standard error.
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

/// At a significance level of one in a thousand.
fn assert_sooner(slow: &[f64], fast: &[f64]) {
    let (mean, error) = sooner_s(slow, fast);
    assert!(mean > 3.1 * error, "{mean} s sooner, give or take {error}");
}

const BOUNCE: &str = "{ kind = \"cruise\" }, { kind = \"random_bounce\" }, { kind = \"avoid\" }";
const SILENT: &str = "[robots.rover.radio]\nrange_m = 0\n";

#[test]
fn remembering_and_sharing_searched_areas_is_faster_than_bouncing() {
    let bounces = times_s(BOUNCE, "", RUNS);
    for (_, sharing) in &*SHARING {
        assert_sooner(&bounces, &sharing[..bounces.len()]);
    }
}

#[test]
fn four_robots_that_share_searched_areas_are_faster_than_four_that_do_not() {
    for ((kind, sharing), runs) in SHARING.iter().zip([FRONTIER_RUNS, RUNS]) {
        assert_sooner(&remembering_s(kind, SILENT, runs), sharing);
    }
}
