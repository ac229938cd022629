//! The visible state of a run, for comparison with traces of the original.

use crate::robot::{Robot, Start};
use crate::simulation::Simulation;

/// Number of paints that a trace records one by one.
pub const TRACED_PAINTS: u64 = 34;

/// A run as the golden traces record it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Hash of the grid before the first paint.
    pub start_grid: String,
    /// Pixels of each robot after each of the first [`TRACED_PAINTS`] paints.
    pub paints: Vec<Vec<[f32; 2]>>,
    /// The team after each decision.
    pub decisions: Vec<Decided>,
}

/// The team after one decision.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// The left-slow score that is passed to the next robot.
    pub carry: i16,
    /// Hash of the grid.
    pub grid: String,
    /// The robots.
    pub robots: Vec<Robot>,
}

/// Runs the plain form from `starts` until `decisions` decisions and 34 paints are recorded.
#[must_use]
pub fn trace(starts: &[Start], decisions: usize) -> Trace {
    let mut run = Simulation::new(starts);
    let mut trace = Trace {
        start_grid: run.grid.hash(),
        paints: Vec::new(),
        decisions: Vec::new(),
    };
    while run.paint < TRACED_PAINTS || trace.decisions.len() < decisions {
        let decided = run.step();
        if run.paint <= TRACED_PAINTS {
            let pixels = run.robots.iter().map(|robot| [robot.x_px, robot.y_px]);
            trace.paints.push(pixels.collect());
        }
        if decided && trace.decisions.len() < decisions {
            trace.decisions.push(Decided {
                carry: run.carry,
                grid: run.grid.hash(),
                robots: run.robots.clone(),
            });
        }
    }
    trace
}
