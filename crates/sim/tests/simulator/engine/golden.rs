//! State hashes of runs, which only change in a commit that states the reason.
//!
//! `golden.txt` lists a scenario, a step, and the state hash after it, for the first steps and the
//! last. To regenerate it:
//!
//! ```text
//! RENEW_GOLDEN=1 cargo test -p agent-economy-sim --test simulator golden
//! ```
//!
//! `make golden` compares builds with other optimisation levels against the same file.

use super::determinism::{commands, crowd};
use crate::common::scenario;
use base::document::Document;
use sim::scenario::ScenarioSpec;
use sim::simulation::Simulation;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

const STEPS: u64 = 50;

fn at(parts: &[&str]) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR")].iter().chain(parts).collect()
}

fn line(name: &str, simulation: &Simulation) -> String {
    let state = simulation.state();
    format!("{name} {} {:016x}\n", state.tick(), state.hash())
}

/// A complete run of a bundled scenario.
fn bundled(name: &str) -> String {
    let open = |file: &str| {
        let file = at(&["../../scenarios", file]);
        fs::read(file).map_err(|why| why.to_string())
    };
    let text = String::from_utf8(open(name).unwrap()).unwrap();
    let document = Document::parse(name, &text).unwrap();
    let checked = ScenarioSpec::read_with(&document, open).unwrap();
    let mut simulation = Simulation::new(Arc::new(checked.scenario), 1, 0).unwrap();
    let mut lines = line(name, &simulation);
    while !simulation.state().is_over(simulation.scenario()) {
        simulation.step();
        if simulation.state().tick() <= STEPS {
            lines += &line(name, &simulation);
        }
    }
    lines + &line(name, &simulation)
}

/// A run that uses every feature; radio messages and some motions are commanded from outside.
fn everything() -> String {
    let mut simulation = Simulation::new(scenario(&crowd(100, 25.0)), 1, 0).unwrap();
    let mut lines = String::new();
    for step in 0..200 {
        let external = commands(&simulation, step);
        simulation.step_with(BTreeMap::new(), external).unwrap();
        if simulation.state().tick() <= STEPS || step == 199 {
            lines += &line("everything", &simulation);
        }
    }
    lines
}

#[test]
fn state_hashes_match_the_golden_file() {
    let mut found = String::new();
    let mut names: Vec<String> = fs::read_dir(at(&["../../scenarios"]))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort_unstable();
    for name in &names {
        let text = fs::read_to_string(at(&["../../scenarios", name]));
        if text.is_ok_and(|text| text.contains("engine = \"metric\"")) {
            found += &bundled(name);
        }
    }
    found += &everything();
    let file = at(&["tests/simulator/engine/golden.txt"]);
    if std::env::var_os("RENEW_GOLDEN").is_some() {
        fs::write(&file, &found).unwrap();
    }
    let golden = fs::read_to_string(&file).unwrap();
    for (found, golden) in found.lines().zip(golden.lines()) {
        assert_eq!(found, golden, "the first step that differs");
    }
    assert_eq!(found.lines().count(), golden.lines().count());
}
