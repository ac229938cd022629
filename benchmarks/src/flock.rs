//! The flock of JuliaDynamics/ABMFrameworksComparison, as declared there: 400 birds on each torus of
//! 150 by 150, with a vision range of 15, for 100 steps from a random start.

use crate::threads::by_turns;
use sim::run::State;
use sim::scenario::{Scenario, ScenarioSpec};
use sim::simulation::Simulation;
use std::sync::Arc;

/// Numbers of birds, and the side of the world for the first one.
const SIZES: [u32; 3] = [1_000, 10_000, 100_000];
const BIRDS: f64 = 400.0;
const SIDE_M: f64 = 150.0;

/// Below this number of birds, one thread does all the work.
const SHARED: u32 = 2_048;

/// Steps of a run, and minimum bird-updates of a sample.
const STEPS: u32 = 100;
const UPDATES: u32 = 1_000_000;

/// Samples for each number of threads.
const PIECES: u32 = 9;

/// Prints the table.
pub(crate) fn report() {
    println!("| birds | threads | millions of updates/s | millions/s, wall clock | hash |");
    println!("|---|---|---|---|---|");
    for birds in sizes() {
        let scenario = Arc::new(scenario(birds));
        let simulation = Simulation::new(scenario, 1, 0).expect("there is room");
        compare(birds, simulation);
    }
}

/// Alternates between one thread and two.
fn compare(birds: u32, mut simulation: Simulation) {
    let start = simulation.state().clone();
    let runs = (UPDATES / (birds * STEPS)).max(1);
    let updates = f64::from(runs) * f64::from(birds) * f64::from(STEPS);
    let (rates, hash) = by_turns(PIECES, updates / 1e6, |_| {
        fly(&mut simulation, &start, runs)
    });
    for each in rates.iter().take(if birds < SHARED { 1 } else { 2 }) {
        let (threads, rate, by_wall) = (each.threads, each.a_second, each.by_wall);
        println!("| {birds} | {threads} | {rate:.2} | {by_wall:.2} | {hash:016x} |");
    }
}

/// Some runs, and the hash of the last final state.
fn fly(simulation: &mut Simulation, start: &State, runs: u32) -> u64 {
    for _ in 0..runs {
        simulation.restore(start.clone());
        (0..STEPS).for_each(|_| simulation.step());
    }
    simulation.state().hash()
}

/// The declared rule, with steps of one second.
fn scenario(birds: u32) -> Scenario {
    let side_m = SIDE_M * (f64::from(birds) / BIRDS).sqrt();
    let swarm = serde_json::json!({
        "kind": "flock", "separation_m": 1.0,
        "separation": 0.015, "alignment": 0.05, "cohesion": 0.03,
    });
    let bird = serde_json::json!({
        "count": birds,
        "radius_m": 0.0,
        "drive": {"max_speed_m_s": 1.0},
        "sensors": {"eyes": {"kind": "robots", "range_m": 15.0, "course_noise_deg": 0.0}},
        "brain": {"behaviours": [swarm]},
    });
    let spec = serde_json::json!({
        "clock": {"step_s": 1.0, "time_limit_s": 1e6},
        "world": {"size_m": [side_m, side_m], "periodic": true},
        "robots": {"bird": bird},
    });
    let spec: ScenarioSpec = serde_json::from_value(spec).expect("it is as it should be");
    Scenario::new(&spec, Vec::new(), Vec::new())
}

/// Sizes of the flocks: from the command line, or the defaults.
fn sizes() -> Vec<u32> {
    let given = std::env::args().nth(2).and_then(|birds| birds.parse().ok());
    given.map_or(SIZES.to_vec(), |birds| vec![birds])
}
