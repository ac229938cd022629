//! A small gate, with every line of the whole one but those that take long, and proof that it is
//! one: it turns red when a constant is broken.
//!
//! Few macro-replications cannot show 95%, so a line stays green as long as they do not refute it:
//! while the upper bound of its share of correct answers, wrong at 1e-4, is at least 0.95. So a
//! sound line is refuted with a probability of at most 1e-4, and one of 40 lines with at most 0.4%;
//! the seed is fixed. A share of 0.90 is refuted with a probability of 99% in 1,000 plays.

use crate::arguments::Arguments;
use crate::binomial::lower_bound;
use crate::gate::{CONFIDENCE, measure};
use crate::lines::{self, Line};
use crate::play::Method;

const SEED: u64 = 1;
const PLAYS: u32 = 1000;
const ALPHA: f64 = 1e-4;

fn is_refuted(line: &Line, plays: u32) -> bool {
    let measured = measure(line, SEED, plays, |_| ());
    // The upper bound of the right is what the lower bound of the wrong leaves.
    lower_bound(plays - measured.correct, plays, ALPHA) > 1.0 - CONFIDENCE
}

fn refuted(lines: impl IntoIterator<Item = Line>) -> Vec<String> {
    let plays = |line: &Line| {
        let slow = line.who == "bounds" || line.problem.contains("teams");
        if slow { PLAYS / 5 } else { PLAYS }
    };
    let red = lines
        .into_iter()
        .filter(|line| is_refuted(line, plays(line)));
    red.map(|line| format!("{} {}", line.who, line.problem))
        .collect()
}

fn is_short(line: &Line) -> bool {
    !line.problem.contains("1000 teams") && !line.problem.contains(".002")
}

#[test]
fn race_and_strict_procedure_and_bounds_keep_their_guarantees() {
    let mut lines = lines::selections(Method::Race);
    lines.extend(lines::selections(Method::Strict));
    lines.extend(lines::coverage());
    lines.retain(is_short);
    assert_eq!(refuted(lines), [""; 0]);
}

#[test]
fn references_need_as_many_runs_as_published() {
    for line in lines::references() {
        let small = line.case.means().len() == 10;
        let measured = measure(&line, SEED, if small { 4000 } else { 200 }, |_| ());
        let name = (line.who, &line.problem);
        assert!(measured.passes(&line), "{name:?} {}", measured.runs);
    }
}

#[test]
fn an_alpha_ten_times_too_large_turns_the_gate_red() {
    for method in [Method::Race, Method::Strict] {
        let line = Line::new("", method, lines::failures(0.2));
        let line = line.breaking(|told| told.confidence = 0.5);
        assert!(is_refuted(&line, PLAYS), "{}", line.who);
        assert!(!measure(&line, SEED, PLAYS, |_| ()).passes(&line));
    }
}

#[test]
fn a_delta_too_large_turns_the_gate_red() {
    for method in [Method::Race, Method::Strict] {
        let line = Line::new("", method, lines::failures(0.2));
        let line = line.breaking(|told| told.deltas = 2.0);
        assert!(is_refuted(&line, PLAYS), "{}", line.who);
        assert!(!measure(&line, SEED, PLAYS, |_| ()).passes(&line));
    }
}

#[test]
fn a_wrong_constant_turns_a_reference_red() {
    let mut lines = lines::references();
    let line = &mut lines[0];
    if let lines::Question::Runs { told, .. } = &mut line.question {
        told.deltas = 1.02;
    }
    assert!(!measure(line, SEED, 4000, |_| ()).passes(line));
}

#[test]
fn a_play_is_the_same_whenever_it_is_played() {
    let line = Line::new("", Method::Race, lines::failures(0.2));
    let (one, other) = (
        measure(&line, SEED, 40, |_| ()),
        measure(&line, SEED, 40, |_| ()),
    );
    assert_eq!(
        (one.correct, one.runs.to_bits()),
        (other.correct, other.runs.to_bits())
    );
}

#[test]
fn a_wrong_command_line_is_told_what_is_wrong() {
    let parse = |words: &str| Arguments::parse(words.split_whitespace().map(str::to_owned));
    assert!(parse("--seed 3 --json").is_ok_and(|arguments| arguments.json && arguments.seed == 3));
    assert!(parse("--sed 3").is_err_and(|fault| fault.contains("no such option")));
    assert!(parse("--seed three").is_err_and(|fault| fault.contains("whole number")));
    assert!(parse("--replications 0").is_err_and(|fault| fault.contains("at least 1")));
}
