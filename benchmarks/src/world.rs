//! Memory and time of a million sensing robots in one world.

use crate::clock::took_by_both;
use crate::field::Field;
use crate::threads::pool;
use sim::simulation::Simulation;
use std::sync::Arc;

const ROBOTS: u32 = 1_000_000;

/// Warm-up steps, after which memory stays constant, and timed steps.
const WARM_UP: u32 = 8;
const STEPS: u32 = 12;

/// Prints the table.
pub(crate) fn report() {
    println!("| threads | peak memory, MB | steps/s | steps/s, wall clock |");
    println!("|---|---|---|---|");
    let field = Field::new(ROBOTS);
    let scenario = Arc::new(field.scenario());
    let simulation = Simulation::new(scenario, 1, 0);
    let mut simulation = simulation.expect("there is room");
    for threads in [1, 2] {
        let pool = pool(threads);
        pool.install(|| (0..WARM_UP).for_each(|_| simulation.step()));
        // Neighbour lists are only rebuilt in some steps, so the mean is reported.
        let steps = || pool.install(|| (0..STEPS).for_each(|_| simulation.step()));
        let [processors_s, wall_s] = took_by_both(steps);
        let rate = f64::from(STEPS * threads) / processors_s;
        let rate_by_wall = f64::from(STEPS) / wall_s;
        println!(
            "| {threads} | {:.0} | {rate:.2} | {rate_by_wall:.2} |",
            memory_mb()
        );
    }
}

/// The peak memory of this process.
fn memory_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) * 1024.0 / 1e6
}
