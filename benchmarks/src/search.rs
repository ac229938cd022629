//! Runs a second of `scenarios/search.toml`, four robots with scanners of 55 rays that search for items,
//! and of `scenarios/search-mind.toml`, the same with minds.

use crate::clock::{median, took_by_both};
use base::document::Document;
use base::runner::{Runner, Work};
use rayon::prelude::*;
use sim::engine::Simulation;
use sim::runner::Runs;
use sim::scenario::{Scenario, ScenarioSpec};
use std::path::Path;
use std::sync::Arc;

/// Runs of a task for a thread, and of a piece of work.
const TASK: u64 = 5;
const PIECE: u64 = 200;
const RUNS: f64 = 200.0;

/// Pieces of work for each number of threads.
const PIECES: u64 = 15;

/// Prints the table.
pub(crate) fn report() {
    println!("| scenario | robot-updates a run | threads | runs/s | by the clock on the wall |");
    println!("|---|---|---|---|---|");
    for name in ["search.toml", "search-mind.toml"] {
        compare(name);
    }
}

/// One thread and two, by turns.
fn compare(name: &str) {
    let scenario = Arc::new(scenario(name));
    let updates = updates_per_run(&scenario);
    let runs = Runs(Arc::clone(&scenario));
    let pools = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().expect("threads can be made")
    });
    let mut rates = [const { Vec::new() }; 4];
    for piece in 0..PIECES {
        for (number, threads) in [(0, 1.0), (1, 2.0)] {
            let work = || pools[number].install(|| block(&runs, piece));
            let [processors_s, wall_s] = took_by_both(work);
            rates[number].push(threads * RUNS / processors_s);
            rates[2 + number].push(RUNS / wall_s);
        }
    }
    let [one, two, one_by_wall, two_by_wall] = rates.map(median);
    println!("| {name} | {updates:.0} | 1 | {one:.0} | {one_by_wall:.0} |");
    println!("| {name} | {updates:.0} | 2 | {two:.0} | {two_by_wall:.0} |");
}

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let text = std::fs::read_to_string(folder.join(name)).expect("the scenario ships");
    let document = Document::parse(name, &text).expect("it is TOML");
    let checked = ScenarioSpec::read(&document).map_err(|faults| faults.to_string());
    checked.expect("it has no faults").scenario
}

fn block(runs: &Runs, piece: u64) {
    let tasks = (0..PIECE / TASK).into_par_iter();
    let outcomes = tasks.map(|task| {
        let first = piece * PIECE + task * TASK;
        runs.run_block(7, first..first + TASK, Work::ALONE)
    });
    let times = outcomes.map(|columns| columns[0].iter().sum::<f64>());
    assert!(times.sum::<f64>().is_finite());
}

/// On average.
#[expect(clippy::cast_precision_loss, reason = "thousands")]
fn updates_per_run(scenario: &Arc<Scenario>) -> f64 {
    let robots = scenario.robots() as f64;
    let steps = (0..100).map(|run| {
        let simulation = Simulation::new(Arc::clone(scenario), 7, run);
        let mut simulation = simulation.expect("there is room");
        simulation.finish();
        simulation.state().tick() as f64
    });
    steps.sum::<f64>() / 100.0 * robots
}
