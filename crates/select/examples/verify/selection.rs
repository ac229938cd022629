//! One selection, from its first run to its last.

use crate::cases::Case;
use crate::random::Place;
use crate::reference::{KimNelson, Rinott};
use select::{EqualAllocation, Problem, Procedure, Race, Strict};

/// The confidence that every line must reach.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// The selection procedure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Method {
    Race,
    Strict,
    /// With its constant, which takes longer to compute than a selection does.
    Rinott {
        first_runs: u32,
        h: f64,
    },
    KimNelson {
        first_runs: u32,
    },
    Equal {
        runs: u32,
    },
}

impl Method {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Race => "race",
            Self::Strict => "strict",
            Self::Rinott { .. } => "Rinott",
            Self::KimNelson { .. } => "KN",
            Self::Equal { .. } => "equal",
        }
    }
}

/// How many runs are recorded at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Batches {
    /// As many as the procedure requests.
    Requested,
    /// One: the procedure may stop after every single run.
    Single,
    /// A random number from 1 to this one, whatever the procedure requests.
    Random(u32),
}

/// How a procedure is set up for a problem; the gate breaks it on purpose to check that it notices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup {
    pub(crate) method: Method,
    pub(crate) batches: Batches,
    pub(crate) confidence: f64,
    /// In units of the problem's own delta.
    pub(crate) deltas: f64,
}

impl Setup {
    /// The true confidence and delta, in the batches that the procedure requests.
    pub(crate) fn correct(method: Method) -> Self {
        Self {
            method,
            batches: Batches::Requested,
            confidence: CONFIDENCE,
            deltas: 1.0,
        }
    }
}

/// The outcome of one macro-replication.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outcome {
    pub(crate) correct: bool,
    pub(crate) runs: u64,
}

/// Runs the macro-replication at `start`; `right` marks the configurations that may be selected.
pub(crate) fn select(case: &dyn Case, right: &[bool], setup: Setup, start: Place) -> Outcome {
    let mut procedure = procedure(case, setup);
    let mut sizes = Place {
        run: u64::MAX,
        ..start
    }
    .shared();
    let mut merits = Vec::new();
    while let Some(request) = procedure.next() {
        let runs = match setup.batches {
            Batches::Requested => request.runs,
            Batches::Single => 1,
            Batches::Random(max) => sizes.one_to(max),
        };
        merits.clear();
        for &configuration in &request.configurations {
            let numbers = request.first_run..request.first_run + runs as u64;
            let merit = |run| case.sample(Place { run, ..start }, configuration);
            merits.extend(numbers.map(merit));
        }
        procedure.record(&merits);
    }
    Outcome {
        correct: procedure.selected().is_some_and(|selected| right[selected]),
        runs: procedure.runs().iter().sum(),
    }
}

fn procedure(case: &dyn Case, setup: Setup) -> Box<dyn Procedure> {
    let problem = Problem {
        bounds: case.bounds(),
        delta: case.delta() * setup.deltas,
        confidence: setup.confidence,
    };
    let (configurations, delta) = (problem.configurations(), problem.delta);
    match setup.method {
        Method::Race => Box::new(Race::new(problem)),
        Method::Strict => Box::new(Strict::new(problem)),
        Method::Rinott { first_runs, h } => {
            let first_runs = u64::from(first_runs);
            Box::new(Rinott::new(configurations, delta, h, first_runs))
        }
        Method::Equal { runs } => Box::new(EqualAllocation::new(configurations, u64::from(runs))),
        Method::KimNelson { first_runs } => {
            let first_runs = first_runs as usize;
            Box::new(KimNelson::new(
                configurations,
                delta,
                setup.confidence,
                first_runs,
            ))
        }
    }
}
