//! The sensing team, compared with the speed of light.

use crate::clock::{median, took};
use crate::field::Field;
use crate::speed_of_light::Team;
use base::geometry::Point;
use sim::simulation::Simulation;
use std::sync::Arc;

/// Robot-updates per sample: many steps even of the largest team, so that the caches evicted by the other
/// programs matter little.
const UPDATES: u32 = 200_000;

/// Samples of each program.
const PIECES: usize = 31;

/// Millions of robot-updates per second of processor time.
struct Rates {
    simulator: f64,
    bare: f64,
    bare_with_noise: f64,
    /// Ratio of the simulator to the minimal program with noise.
    ratio: f64,
}

/// Prints the table.
pub(crate) fn report() {
    println!("| robots | simulator | minimal program | minimal, with noise | ratio |");
    println!("|---|---|---|---|---|");
    for robots in sizes() {
        let rates = rates(robots);
        println!(
            "| {robots} | {:.2} | {:.2} | {:.2} | {:.2} |",
            rates.simulator, rates.bare, rates.bare_with_noise, rates.ratio
        );
    }
}

fn rates(robots: u32) -> Rates {
    let field = Field::new(robots);
    let scenario = Arc::new(field.scenario());
    let mut simulation = Simulation::new(scenario, 1, 0).expect("there is room");
    let starts = starts(&simulation);
    let mut bare = Team::new(&field, &starts, false);
    let mut noisy = Team::new(&field, &starts, true);
    let steps = (UPDATES / robots).max(1);
    let mut rates = [const { Vec::new() }; 3];
    for _ in 0..PIECES {
        let mut piece = |number: usize, step: &mut dyn FnMut()| {
            let took_s = took(|| (0..steps).for_each(|_| step()));
            rates[number].push(f64::from(steps * robots) / took_s / 1e6);
        };
        piece(0, &mut || simulation.step());
        piece(1, &mut || bare.step());
        piece(2, &mut || noisy.step());
    }
    assert!(bare.sum().is_finite() && noisy.sum().is_finite());
    let ratios = rates[0]
        .iter()
        .zip(&rates[2])
        .map(|(one, other)| one / other);
    let ratio = median(ratios.collect());
    let [simulator, bare, bare_with_noise] = rates.map(median);
    Rates {
        simulator,
        bare,
        bare_with_noise,
        ratio,
    }
}

/// Positions and headings of the robots.
pub(crate) fn starts(simulation: &Simulation) -> Vec<(Point, f64)> {
    let each = simulation.state().each_robot(simulation.scenario());
    each.map(|robot| (robot.at, robot.heading_rad)).collect()
}

/// Sizes of the teams: from the command line, or the defaults.
fn sizes() -> Vec<u32> {
    let given = std::env::args()
        .nth(2)
        .and_then(|robots| robots.parse().ok());
    given.map_or(vec![100, 1_600, 10_000], |robots| vec![robots])
}
