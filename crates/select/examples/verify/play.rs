//! One selection, played to its end.

use crate::cases::Case;
use crate::gate::CONFIDENCE;
use crate::random::Place;
use select::reference::{Equal, KimNelson, Rinott};
use select::{Problem, Procedure, Race, Strict};

/// Who selects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Method {
    Race,
    Strict,
    /// With its constant, which takes longer to compute than a selection.
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

/// How many runs are told at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Batches {
    /// As many as the procedure asks for.
    Asked,
    /// One: the procedure may stop after every single run.
    Single,
    /// From 1 to so many, at random, whatever the procedure asks for.
    Random(u32),
}

/// What a procedure is told of a problem; the gate breaks it on purpose to see whether that shows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Told {
    pub(crate) method: Method,
    pub(crate) batches: Batches,
    pub(crate) confidence: f64,
    /// In units of the problem's own delta.
    pub(crate) deltas: f64,
}

impl Told {
    /// What is true, in the batches that the procedure asks for.
    pub(crate) fn honestly(method: Method) -> Self {
        Self {
            method,
            batches: Batches::Asked,
            confidence: CONFIDENCE,
            deltas: 1.0,
        }
    }
}

/// What came out of one macro-replication.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Played {
    pub(crate) correct: bool,
    pub(crate) runs: u64,
}

/// Plays the macro-replication at `start` to its end; `right` says what may be selected.
pub(crate) fn play(case: &dyn Case, right: &[bool], told: Told, start: Place) -> Played {
    let mut procedure = procedure(case, told);
    let mut sizes = Place {
        run: u64::MAX,
        ..start
    }
    .shared();
    let mut merits = Vec::new();
    while let Some(request) = procedure.next() {
        let runs = match told.batches {
            Batches::Asked => request.runs,
            Batches::Single => 1,
            Batches::Random(most) => sizes.one_to(most),
        };
        merits.clear();
        for &configuration in &request.configurations {
            let numbers = request.first_run..request.first_run + runs as u64;
            let merit = |run| case.sample(Place { run, ..start }, configuration);
            merits.extend(numbers.map(merit));
        }
        procedure.tell(&merits);
    }
    Played {
        correct: right[procedure.best()],
        runs: procedure.runs().iter().sum(),
    }
}

fn procedure(case: &dyn Case, told: Told) -> Box<dyn Procedure> {
    let problem = Problem {
        bounds: case.bounds(),
        delta: case.delta() * told.deltas,
        confidence: told.confidence,
    };
    let (configurations, delta) = (problem.configurations(), problem.delta);
    match told.method {
        Method::Race => Box::new(Race::new(problem)),
        Method::Strict => Box::new(Strict::new(problem)),
        Method::Rinott { first_runs, h } => {
            let first_runs = u64::from(first_runs);
            Box::new(Rinott::with_constant(configurations, delta, h, first_runs))
        }
        Method::Equal { runs } => Box::new(Equal::new(configurations, u64::from(runs))),
        Method::KimNelson { first_runs } => {
            let first_runs = first_runs as usize;
            Box::new(KimNelson::new(
                configurations,
                delta,
                told.confidence,
                first_runs,
            ))
        }
    }
}
