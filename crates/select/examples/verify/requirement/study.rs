//! One study of a known problem.

use crate::random::Place;
use crate::requirement::problems::Known;
use select::{Procedure, Requirement, RequirementProblem};

/// How runs are passed to the procedure.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Batches {
    Requested,
    Single,
    /// Random sizes up to a maximum.
    Random(u32),
}

/// What a study states.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Statement {
    /// The promise.
    Promise,
    /// Which configurations do not meet the requirement at all.
    Below,
}

/// What a study takes as given, which differs from the truth if it is broken on purpose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup {
    pub(crate) batches: Batches,
    pub(crate) confidence: f64,
    /// Added to p0.
    pub(crate) probability_off: f64,
    /// The tolerance of the finer question, as a part of the problem's; 1 for none.
    pub(crate) finer: f64,
    pub(crate) statement: Statement,
}

/// The outcome of one study.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outcome {
    pub(crate) is_kept: bool,
    pub(crate) runs: u64,
}

/// Runs the macro-replication at `start`.
pub(crate) fn run(problem: &Known, setup: Setup, start: Place) -> Outcome {
    let tolerance = setup.finer * problem.tolerance;
    let mut procedure = Requirement::new(RequirementProblem {
        costs: problem.costs.clone(),
        probability: problem.probability + setup.probability_off,
        tolerance: problem.tolerance,
        finer: (setup.finer < 1.0).then_some(tolerance),
        confidence: setup.confidence,
    });
    let mut sizes = Place {
        run: u64::MAX,
        ..start
    }
    .shared();
    while let Some(request) = procedure.next() {
        let runs = match setup.batches {
            Batches::Requested => request.runs,
            Batches::Single => 1,
            Batches::Random(max) => sizes.one_to(max),
        };
        let configuration = request.configurations[0];
        let numbers = request.first_run..request.first_run + runs as u64;
        let met = numbers.map(|run| problem.sample(Place { run, ..start }, configuration));
        let met: Vec<f64> = met.map(|met| f64::from(u8::from(met))).collect();
        procedure.record(&met);
    }
    Outcome {
        is_kept: match setup.statement {
            Statement::Promise => problem.is_kept(procedure.selected(), tolerance),
            Statement::Below => problem.is_below_right(&procedure.below()),
        },
        runs: procedure.runs().iter().sum(),
    }
}
