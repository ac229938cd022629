//! A small gate: every problem except the slow ones, and a proof that it can fail. Few
//! macro-replications cannot prove 95%, so a line passes as long as they do not refute it, at 1e-4: one
//! of 30 sound lines is refuted with a probability of at most 0.3%; the seed is fixed.

use crate::requirement::lines::{self, Line, measure};
use crate::requirement::problems;

const SEED: u64 = 1;
const TRIALS: u32 = 400;
const ALPHA: f64 = 1e-4;

fn refuted(lines: impl IntoIterator<Item = Line>) -> Vec<String> {
    let refuted = lines
        .into_iter()
        .filter(|line| measure(line, SEED, TRIALS).refutes(ALPHA));
    refuted.map(|line| line.name).collect()
}

#[test]
fn studies_keep_the_promise() {
    let mut lines = lines::all();
    lines.retain(|line| !line.name.starts_with("anchor"));
    let broken: Vec<String> = lines::broken(&problems::all())
        .into_iter()
        .map(|line| line.name)
        .collect();
    lines.retain(|line| {
        !broken.contains(&line.name) && line.replications > 1000 && !line.name.contains(".999")
    });
    assert!(lines.len() >= 20);
    assert_eq!(refuted(lines), [""; 0]);
}

#[test]
fn a_wrong_probability_or_confidence_fails_the_gate() {
    let lines = lines::broken(&problems::all());
    let names: Vec<String> = lines.iter().map(|line| line.name.clone()).collect();
    assert!(names.len() >= 3);
    assert_eq!(refuted(lines), names);
}

#[test]
fn a_measurement_can_be_repeated() {
    let line = &lines::all()[0];
    let [one, other] = [0, 1].map(|_| measure(line, SEED, 40));
    assert_eq!(
        (one.share().to_bits(), one.runs.to_bits()),
        (other.share().to_bits(), other.runs.to_bits())
    );
}
