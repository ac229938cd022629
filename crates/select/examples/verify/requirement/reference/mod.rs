//! Other ways to answer the same question, for comparison. Each decides one configuration after the
//! other, the cheapest first, until one is found feasible, as the procedure for requirements does.

mod feasibility_check;
mod fixed_design;
mod wald;

pub(crate) use feasibility_check::FeasibilityCheck;
pub(crate) use fixed_design::FixedDesign;
pub(crate) use wald::Wald;

use crate::random::Place;
use crate::requirement::problems::Known;
use crate::requirement::study::Outcome;

/// A way to decide whether a configuration meets a requirement.
pub(crate) trait Reference: Sync {
    /// The decision and the number of runs, given the runs as a function of their number.
    fn decide(&self, is_met: &dyn Fn(u64) -> bool) -> (bool, u64);
}

/// A study with a reference procedure.
pub(crate) fn run(reference: &dyn Reference, problem: &Known, start: Place) -> Outcome {
    let mut order: Vec<usize> = (0..problem.met.len()).collect();
    order.sort_by(|a, b| problem.costs[*a].total_cmp(&problem.costs[*b]));
    let mut runs = 0;
    let selected = order.into_iter().find(|configuration| {
        let is_met = |run| problem.sample(Place { run, ..start }, *configuration);
        let (is_feasible, used) = reference.decide(&is_met);
        runs += used;
        is_feasible
    });
    Outcome {
        is_kept: problem.is_kept(selected, problem.tolerance),
        runs,
    }
}
