//! Beliefs are calibrated: of the items that robots believe in with confidence 0.8, 80% exist.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{robots, run, scenario, time_s};
use base::document::Value;
use base::geometry::Point;
use rayon::prelude::*;
use sim::simulation::Simulation;
use std::ops::Range;

pub(crate) const TEXT: &str = include_str!("../../../../docs/validation/calibration.toml");

pub(crate) const UNCERTAIN: &str = include_str!("../../../../docs/validation/uncertain-kinds.toml");

const RUNS: u64 = 64;

/// Times at which beliefs are evaluated, in seconds.
const EVALUATED_S: [f64; 4] = [10.0, 20.0, 40.0, 80.0];

/// A belief is true if an item is within three standard deviations plus this distance.
const NEAR_M: f64 = 0.1;

/// Beliefs are grouped by tenths of confidence, and the surest ones more finely.
const EDGES: [f64; 13] = [
    0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01,
];

/// Groups with beliefs from fewer runs are omitted.
const MIN_RUNS: usize = 20;

/// The confidence of a belief, and whether it is true.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Belief {
    confidence: f64,
    is_true: bool,
}

/// Changed values of the scenario, by path.
pub(crate) type Changes = Vec<(&'static str, Value)>;

pub(crate) fn camera() -> [(&'static str, Changes); 3] {
    let set = |path, value| vec![(path, Value::Float(value))];
    [
        ("sharp", vec![]),
        ("coarse", set("robots.rover.sensors.camera.noise_m", 0.4)),
        (
            "faint",
            set(
                "robots.rover.sensors.camera.detection_probability.mine",
                0.15,
            ),
        ),
    ]
}

pub(crate) fn radio(range_m: f64) -> (&'static str, Value) {
    ("robots.rover.radio.range_m", Value::Float(range_m))
}

/// The current beliefs of all robots.
fn evaluated(simulation: &Simulation) -> Vec<Belief> {
    let each = simulation.state().each_item(simulation.scenario());
    let items: Vec<(u16, Point)> = each.map(|item| (item.kind, item.at)).collect();
    let ids = robots(simulation).into_iter().map(|robot| robot.id);
    let belief_state = ids.filter_map(|id| simulation.state().belief_state(id));
    let believed = belief_state.flat_map(|belief_state| belief_state.items);
    let belief = |item: brain::BelievedItem| {
        let near_m = 3.0 * item.deviation_m + NEAR_M;
        let is_it =
            |(kind, at): &(u16, Point)| *kind == item.kind && at.to(item.at).length() <= near_m;
        Belief {
            confidence: item.confidence,
            is_true: items.iter().any(is_it),
        }
    };
    believed.map(belief).collect()
}

/// The beliefs of each run.
pub(crate) fn believed(text: &str, changes: &[(&str, Value)], runs: u64) -> Vec<Vec<Belief>> {
    let scenario = scenario(text, changes);
    let of_run = |number| {
        let mut simulation = run(&scenario, 1, number);
        let mut all = Vec::new();
        for at_s in EVALUATED_S {
            while time_s(&simulation) < at_s - 1e-6 {
                simulation.step();
            }
            all.extend(evaluated(&simulation));
        }
        all
    };
    (0..runs).into_par_iter().map(of_run).collect()
}

/// Of a run's beliefs in a bin: the number, the number of true ones, and the sum of confidences.
fn sums(beliefs: &[Belief], bin: &Range<f64>) -> [f64; 3] {
    let is_in = |belief: &&Belief| bin.contains(&belief.confidence);
    let in_bin = beliefs.iter().filter(is_in);
    in_bin.fold([0.0; 3], |[count, right, sum], belief| {
        let right = right + f64::from(u8::from(belief.is_true));
        [count + 1.0, right, sum + belief.confidence]
    })
}

/// The share of true beliefs in a bin, and their mean confidence.
///
/// Beliefs of one run refer to the same items, so runs are clusters: the standard error is that of a
/// ratio of sums over runs, and at least that of one independent belief per run.
fn share(series: &str, runs: &[Vec<Belief>], bin: &Range<f64>) -> Option<Row> {
    let each = runs.iter().map(|beliefs| sums(beliefs, bin));
    let each: Vec<[f64; 3]> = each.filter(|[count, ..]| *count > 0.0).collect();
    if each.len() < MIN_RUNS {
        return None;
    }
    let [count, right, sum] =
        [0, 1, 2].map(|place| each.iter().map(|sums| sums[place]).sum::<f64>());
    let clusters = f64::from(u32::try_from(each.len()).unwrap());
    let (believed, off) = (sum / count, (right - sum) / count);
    let residuals = each
        .iter()
        .map(|[count, right, sum]| right - sum - off * count);
    let squares: f64 = residuals.map(|residual| residual * residual).sum();
    let error = (squares * clusters / (clusters - 1.0)).sqrt() / count;
    let min_error = (believed * (1.0 - believed) / clusters).sqrt();
    Some(Row {
        series: series.to_owned(),
        x: believed,
        measured: right / count,
        error: error.max(min_error),
        expected: Some(believed),
    })
}

fn rows(series: &str, changes: &[(&str, Value)]) -> Vec<Row> {
    rows_of(series, &believed(TEXT, changes, RUNS))
}

pub(crate) fn rows_of(series: &str, runs: &[Vec<Belief>]) -> Vec<Row> {
    let bins = EDGES.windows(2).map(|edges| edges[0]..edges[1]);
    bins.filter_map(|bin| share(series, runs, &bin)).collect()
}

#[test]
fn the_share_of_true_beliefs_equals_their_confidence() {
    let mut all = Vec::new();
    for (name, mut changes) in camera() {
        changes.push(radio(0.0));
        all.extend(rows(&format!("{name} alone"), &changes));
        changes.push(radio(100.0));
        all.extend(rows(&format!("{name} with radio"), &changes));
    }
    let distrust = [(
        "robots.rover.brain.beliefs.trust.initial",
        Value::Float(0.9),
    )];
    let wary = rows("sharp with radio and trust 0.9", &distrust);
    all.extend(wary.into_iter().map(|row| Row {
        expected: None,
        ..row
    }));
    assert_published("calibration.csv", &all);
    assert_right(&all);
}

#[test]
fn a_tenfold_prior_count_is_detected() {
    let many = (
        "robots.rover.brain.beliefs.prior_count.mine",
        Value::Float(80.0),
    );
    assert_wrong(&rows("", &[many]));
}

#[test]
fn the_share_of_true_beliefs_in_uncertain_kinds_equals_their_confidence() {
    let alone = believed(UNCERTAIN, &[radio(0.0)], RUNS);
    let alone = rows_of("alone", &alone);
    let together = believed(UNCERTAIN, &[radio(100.0)], RUNS);
    let together = rows_of("with radio", &together);
    let all = [alone, together].concat();
    assert_published("uncertain-kinds.csv", &all);
    assert_right(&all);
}
