//! Runs per second of `scenarios/search.toml`, four robots with scanners of 55 rays that search for
//! items, and of `scenarios/search-beliefs.toml`, the same with beliefs.

use crate::scenarios::read;
use crate::threads::by_turns;
use base::engine::{BlockOptions, Runner};
use rayon::prelude::*;
use sim::runner::Runs;
use sim::scenario::Scenario;
use sim::simulation::Simulation;
use std::path::Path;
use std::sync::Arc;

/// Runs per task of a thread, and per sample.
const TASK: u64 = 5;
const PIECE: u64 = 200;
const RUNS: f64 = 200.0;

/// Samples for each number of threads.
const PIECES: u32 = 15;

/// Prints the table.
pub(crate) fn report() {
    println!("| scenario | robot updates per run | threads | runs/s | runs/s, wall clock |");
    println!("|---|---|---|---|---|");
    for name in ["search.toml", "search-beliefs.toml"] {
        compare(name);
    }
}

/// Alternates between one thread and two.
fn compare(name: &str) {
    let scenario = Arc::new(scenario(name));
    let updates = updates_per_run(&scenario);
    let runs = Runs(Arc::clone(&scenario));
    let (rates, _) = by_turns(PIECES, RUNS, |piece| block(&runs, piece.into()));
    for each in &rates {
        let (threads, rate, by_wall) = (each.threads, each.a_second, each.by_wall);
        println!("| {name} | {updates:.0} | {threads} | {rate:.0} | {by_wall:.0} |");
    }
}

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let text = std::fs::read_to_string(folder.join(name)).expect("the scenario ships");
    read(name, &text)
}

/// A sample: the bits of the sum of the runs' times.
fn block(runs: &Runs, piece: u64) -> u64 {
    let tasks = (0..PIECE / TASK).into_par_iter();
    let times = tasks.map(|task| {
        let first = piece * PIECE + task * TASK;
        let columns = runs.run_block(7, first..first + TASK, BlockOptions::ALONE);
        columns[0].iter().sum::<f64>()
    });
    // In the order of the tasks, for any assignment to threads.
    let times: Vec<f64> = times.collect();
    times.iter().sum::<f64>().to_bits()
}

/// Average.
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
