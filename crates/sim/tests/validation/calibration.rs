//! Beliefs are calibrated: of the items that robots believe in with confidence 0.8, 80% exist.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{robots, run, scenario, time_s};
use base::document::Value;
use base::geometry::Point;
use rayon::prelude::*;
use sim::simulation::Simulation;

const TEXT: &str = include_str!("../../../../docs/validation/calibration.toml");

const UNCERTAIN: &str = include_str!("../../../../docs/validation/uncertain-kinds.toml");

const RUNS: u64 = 64;

/// Times at which beliefs are evaluated, in seconds.
const EVALUATED_S: [f64; 4] = [10.0, 20.0, 40.0, 80.0];

/// A belief is true if an item is within three standard deviations plus this distance.
const NEAR_M: f64 = 0.1;

/// Beliefs are grouped by tenths of confidence.
const BINS: u8 = 10;

/// Groups with beliefs from fewer runs are omitted.
const MIN_RUNS: usize = 20;

/// The confidence of a belief, and whether it is true.
#[derive(Debug, Clone, Copy)]
struct Belief {
    confidence: f64,
    is_true: bool,
}

/// Changed values of the scenario, by path.
type Changes = Vec<(&'static str, Value)>;

fn camera() -> [(&'static str, Changes); 3] {
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

fn radio(range_m: f64) -> (&'static str, Value) {
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
fn believed(text: &str, changes: &[(&str, Value)]) -> Vec<Vec<Belief>> {
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
    (0..RUNS).into_par_iter().map(of_run).collect()
}

/// Of a run's beliefs in a bin: the number, the number of true ones, and the sum of confidences.
fn sums(beliefs: &[Belief], bin: u8) -> [f64; 3] {
    let [low, high] = [bin, bin + 1].map(|edge| f64::from(edge) / f64::from(BINS));
    let is_last = bin + 1 == BINS;
    let is_in =
        |belief: &&Belief| belief.confidence >= low && (belief.confidence < high || is_last);
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
fn share(series: &str, runs: &[Vec<Belief>], bin: u8) -> Option<Row> {
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
    rows_of(TEXT, series, changes)
}

fn rows_of(text: &str, series: &str, changes: &[(&str, Value)]) -> Vec<Row> {
    let runs = believed(text, changes);
    (0..BINS)
        .filter_map(|bin| share(series, &runs, bin))
        .collect()
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
    let alone = rows_of(UNCERTAIN, "alone", &[radio(0.0)]);
    let together = rows_of(UNCERTAIN, "with radio", &[radio(100.0)]);
    let all = [alone, together].concat();
    assert_published("uncertain-kinds.csv", &all);
    assert_right(&all);
}

/// A camera like that of an OAV over a lane.
fn oav() -> Changes {
    vec![]
}

#[test]
#[ignore]
fn measure_calibration() {
    const EDGES: [f64; 13] = [
        0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0,
    ];
    let runs: u64 = std::env::var("CAL_RUNS")
        .ok()
        .and_then(|r| r.parse().ok())
        .unwrap_or(300);
    let only = std::env::var("CAL_ONLY").unwrap_or_default();
    let mut cases: Vec<(String, &str, Changes)> = Vec::new();
    for (name, changes) in camera() {
        for (radio_name, range) in [("alone", 0.0), ("radio", 100.0)] {
            let mut changes = changes.clone();
            changes.push(radio(range));
            cases.push((format!("{name} {radio_name}"), TEXT, changes));
        }
    }
    for (radio_name, range) in [("alone", 0.0), ("radio", 100.0)] {
        cases.push((format!("kinds {radio_name}"), UNCERTAIN, vec![radio(range)]));
        cases.push((format!("oav {radio_name}"), OAV, vec![radio(range)]));
        cases.push((format!("oavwide {radio_name}"), OAVW, vec![radio(range)]));
        cases.push((format!("blind {radio_name}"), BLIND, vec![radio(range)]));
        cases.push((
            format!("confused {radio_name}"),
            CONFUSED,
            vec![radio(range)],
        ));
    }
    let _ = oav();
    for (name, text, changes) in cases {
        if !name.contains(&only) {
            continue;
        }
        let scenario = scenario(text, &changes);
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
        let each: Vec<Vec<Belief>> = (0..runs).into_par_iter().map(of_run).collect();
        println!("## {name}");
        for pair in EDGES.windows(2) {
            let sums = |beliefs: &Vec<Belief>| {
                let in_bin = beliefs
                    .iter()
                    .filter(|b| b.confidence >= pair[0] && b.confidence < pair[1]);
                in_bin.fold([0.0; 3], |[n, r, c], b| {
                    [
                        n + 1.0,
                        r + f64::from(u8::from(b.is_true)),
                        c + b.confidence,
                    ]
                })
            };
            let sums: Vec<[f64; 3]> = each.iter().map(sums).filter(|s| s[0] > 0.0).collect();
            if sums.len() < 10 {
                continue;
            }
            let [n, r, c] = [0, 1, 2].map(|k| sums.iter().map(|s| s[k]).sum::<f64>());
            let off = (r - c) / n;
            let k = sums.len() as f64;
            let squares: f64 = sums
                .iter()
                .map(|s| (s[1] - s[2] - off * s[0]).powi(2))
                .sum();
            let held = c / n;
            let error =
                ((squares * k / (k - 1.0)).sqrt() / n).max((held * (1.0 - held) / k).sqrt());
            let mark = if (off / error).abs() > 3.0 {
                " <<<"
            } else {
                ""
            };
            println!(
                "{:.2}-{:.2} held {held:.4} true {:.4} off {off:+.4} se {error:.4} z {:+.1} runs {} n {n}{mark}",
                pair[0],
                pair[1],
                r / n,
                off / error,
                sums.len()
            );
        }
    }
}

const OAV: &str = include_str!("/tmp/w/oav.toml");
const OAVW: &str = include_str!("/tmp/w/oavw.toml");
const BLIND: &str = include_str!("/tmp/w/blind.toml");
const CONFUSED: &str = include_str!("/tmp/w/confused.toml");

#[test]
#[ignore]
fn diagnose_calibration() {
    let low: f64 = std::env::var("CAL_LOW")
        .ok()
        .and_then(|r| r.parse().ok())
        .unwrap_or(0.8);
    let high: f64 = std::env::var("CAL_HIGH")
        .ok()
        .and_then(|r| r.parse().ok())
        .unwrap_or(1.1);
    let runs: u64 = std::env::var("CAL_RUNS")
        .ok()
        .and_then(|r| r.parse().ok())
        .unwrap_or(100);
    let case = std::env::var("CAL_ONLY").unwrap_or_default();
    let cases: Vec<(&str, &str, f64)> = vec![
        ("sharp alone", TEXT, 0.0),
        ("sharp radio", TEXT, 100.0),
        ("coarse alone", TEXT, 0.0),
        ("coarse radio", TEXT, 100.0),
        ("oav alone", OAV, 0.0),
        ("oav radio", OAV, 100.0),
        ("oavwide alone", OAVW, 0.0),
        ("oavwide radio", OAVW, 100.0),
        ("confused alone", CONFUSED, 0.0),
        ("confused radio", CONFUSED, 100.0),
        ("kinds radio", UNCERTAIN, 100.0),
    ];
    for (name, text, range) in cases {
        if name != case {
            continue;
        }
        let mut changes = vec![radio(range)];
        if name.starts_with("coarse") {
            changes.extend(camera()[1].1.clone());
        }
        let scenario = scenario(text, &changes);
        for number in 0..runs {
            let mut simulation = run(&scenario, 1, number);
            let mut n = 0;
            let mut wrong = 0;
            for at_s in EVALUATED_S {
                while time_s(&simulation) < at_s - 1e-6 {
                    simulation.step();
                }
                let each = simulation.state().each_item(simulation.scenario());
                let items: Vec<(u16, Point)> = each.map(|item| (item.kind, item.at)).collect();
                for robot in robots(&simulation) {
                    let Some(state) = simulation.state().belief_state(robot.id) else {
                        continue;
                    };
                    for item in &state.items {
                        if item.confidence < low || item.confidence >= high {
                            continue;
                        }
                        n += 1;
                        let near_m = 3.0 * item.deviation_m + NEAR_M;
                        let same = items
                            .iter()
                            .any(|(k, at)| *k == item.kind && at.to(item.at).length() <= near_m);
                        if std::env::var("CAL_ALL").is_err() && same {
                            continue;
                        }
                        wrong += 1;
                        let nearest = items
                            .iter()
                            .map(|(k, at)| (at.to(item.at).length(), *k))
                            .min_by(|a, b| a.0.total_cmp(&b.0))
                            .unwrap();
                        let other = state
                            .items
                            .iter()
                            .filter(|o| o.at != item.at)
                            .map(|o| {
                                (
                                    o.at.to(item.at).length(),
                                    o.confidence,
                                    o.kind,
                                    o.deviation_m,
                                )
                            })
                            .min_by(|a, b| a.0.total_cmp(&b.0));
                        println!(
                            "{same} run {number} t {at_s} robot {:?} conf {:.3} kind {} dev {:.3} at {:.2},{:.2} nearest item {:.2} kind {} ; other track {:?} pose dev {:?}",
                            robot.id,
                            item.confidence,
                            item.kind,
                            item.deviation_m,
                            item.at.x,
                            item.at.y,
                            nearest.0,
                            nearest.1,
                            other,
                            state.pose.as_ref().map(|p| p.deviation_m)
                        );
                    }
                }
            }
            let _ = (n, wrong);
        }
    }
}
#[test]
#[ignore]
fn trace_place() {
    let mut changes = vec![radio(100.0)];
    changes.extend(camera()[1].1.clone());
    let scenario = scenario(TEXT, &changes);
    let place = Point { x: 13.13, y: 1.02 };
    let mut simulation = run(&scenario, 1, 0);
    let mut last = String::new();
    for _ in 0..110 {
        simulation.step();
        let mut line = String::new();
        for robot in robots(&simulation) {
            let Some(state) = simulation.state().belief_state(robot.id) else {
                continue;
            };
            for item in &state.items {
                if item.at.to(place).length() < 2.0 {
                    line += &format!(
                        " r{} {:.2},{:.2} c {:.4} dev {:.2} |",
                        robot.id.index, item.at.x, item.at.y, item.confidence, item.deviation_m
                    );
                }
            }
        }
        if line != last {
            println!("trace {:.1} {line}", time_s(&simulation));
            last = line;
        }
    }
}
