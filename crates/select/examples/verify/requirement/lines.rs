//! What is measured, and what passes.

use crate::binomial::lower_bound;
use crate::random::Place;
use crate::requirement::problems::{self, Known};
use crate::requirement::reference::{self, FeasibilityCheck, FixedDesign, Reference, Wald};
use crate::requirement::study::{self, Batches, Outcome, Setup, Statement};
use rayon::prelude::*;

pub(crate) const CONFIDENCE: f64 = 0.95;

/// The bound of a share of studies is wrong with at most this probability.
const ALPHA: f64 = 0.01;

const MANY: u32 = 20_000;
/// Of a line that would take minutes with that many.
const FEW: u32 = 1000;

/// One line of the table.
pub(crate) struct Line {
    pub(crate) name: String,
    problem: Known,
    method: Method,
    expected: Expected,
    pub(crate) replications: u32,
}

enum Method {
    Requirement(Setup),
    Reference(Box<dyn Reference>),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Expected {
    Kept,
    Broken,
    /// Other procedures may do either.
    Any,
}

/// The result of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) replications: u32,
    kept: u32,
    /// On average, of all configurations together.
    pub(crate) runs: f64,
}

impl Measured {
    /// Share of studies that keep the promise.
    pub(crate) fn share(&self) -> f64 {
        f64::from(self.kept) / f64::from(self.replications)
    }

    /// 99% lower bound of that share.
    pub(crate) fn lower(&self) -> f64 {
        lower_bound(self.kept, self.replications, ALPHA)
    }

    /// Whether the share is proved to be below the confidence; `true` is wrong with a probability of
    /// at most `alpha`.
    pub(crate) fn refutes(&self, alpha: f64) -> bool {
        lower_bound(self.replications - self.kept, self.replications, alpha) > 1.0 - CONFIDENCE
    }
}

impl Line {
    fn new(name: &str, problem: &Known, setup: Setup) -> Self {
        let is_long = problem.met.len() > 100;
        Self {
            name: name.to_owned(),
            problem: problem.clone(),
            method: Method::Requirement(setup),
            expected: Expected::Kept,
            replications: if is_long { FEW } else { MANY },
        }
    }

    fn anchor(name: &str, problem: &Known, reference: impl Reference + 'static) -> Self {
        Self {
            name: format!("{name}: {}", problem.name),
            problem: problem.clone(),
            method: Method::Reference(Box::new(reference)),
            expected: Expected::Any,
            replications: FEW,
        }
    }

    /// Whether the line passes.
    pub(crate) fn passes(&self, measured: &Measured) -> bool {
        match self.expected {
            Expected::Kept => measured.lower() >= CONFIDENCE,
            Expected::Broken => measured.refutes(ALPHA),
            Expected::Any => true,
        }
    }

    fn answer(&self, place: Place) -> Outcome {
        match &self.method {
            Method::Requirement(setup) => study::run(&self.problem, *setup, place),
            Method::Reference(reference) => reference::run(&**reference, &self.problem, place),
        }
    }
}

const CORRECT: Setup = Setup {
    batches: Batches::Requested,
    confidence: CONFIDENCE,
    probability_off: 0.0,
    finer: 1.0,
    statement: Statement::Promise,
};

/// All lines, in the table's order.
pub(crate) fn all() -> Vec<Line> {
    let problems = problems::all();
    let mut lines: Vec<Line> = problems
        .iter()
        .map(|each| Line::new(each.name, each, CORRECT))
        .collect();
    lines.extend(finer(&problems));
    lines.extend(batches(&problems));
    lines.extend(broken(&problems));
    for problem in problems.iter().take(4) {
        lines.extend(anchors(problem));
    }
    let inside = problems.iter().filter(|each| each.name == "8 teams inside");
    lines.extend(inside.flat_map(anchors));
    lines
}

/// Teams at each limit of the finer question, which follows at a quarter of the tolerance.
fn finer(problems: &[Known]) -> Vec<Line> {
    let setup = Setup {
        finer: 0.25,
        ..CORRECT
    };
    let eight = problems
        .iter()
        .filter(|each| each.name.starts_with("8 teams"));
    let mut finer: Vec<Known> = eight.cloned().collect();
    finer.extend(finer.first().cloned().map(|first| Known {
        name: "8 teams at p0 + t / 4",
        met: vec![first.probability + first.tolerance / 4.0; 8],
        ..first
    }));
    let line = |each: &Known| Line {
        replications: FEW,
        ..Line::new(&format!("{}, finer", each.name), each, setup)
    };
    let mut lines: Vec<Line> = finer.iter().map(line).collect();
    let below = Setup {
        statement: Statement::Below,
        ..setup
    };
    let at_the_limit = problems.iter().filter(|each| each.name.starts_with("7 "));
    lines.extend(at_the_limit.map(|each| Line {
        replications: FEW,
        ..Line::new(&format!("{}, below", each.name), each, below)
    }));
    lines
}

/// The hardest problems, in batches that the procedure does not request.
fn batches(problems: &[Known]) -> Vec<Line> {
    let mut lines = Vec::new();
    for problem in problems
        .iter()
        .filter(|each| each.name.starts_with("8 teams") || each.name.starts_with("1 team "))
    {
        for (words, batches) in [
            ("run by run", Batches::Single),
            ("random batches", Batches::Random(50)),
        ] {
            let setup = Setup { batches, ..CORRECT };
            lines.push(Line::new(
                &format!("{}, {words}", problem.name),
                problem,
                setup,
            ));
        }
    }
    lines
}

/// What must be found broken; otherwise the gate would not notice errors.
pub(crate) fn broken(problems: &[Known]) -> Vec<Line> {
    let broken = |words: &str, setup: Setup| {
        let lines = problems
            .iter()
            .filter(|each| each.name.starts_with("1 team "));
        let line = |problem: &Known| Line {
            expected: Expected::Broken,
            ..Line::new(&format!("{}, {words}", problem.name), problem, setup)
        };
        lines.map(line).collect::<Vec<Line>>()
    };
    // Wrong by as much, p0 harms the one problem if it is too low and the other if it is too high.
    let mut lines = broken(
        "a third of the confidence",
        Setup {
            confidence: 0.3,
            ..CORRECT
        },
    );
    let off = |probability_off| Setup {
        probability_off,
        ..CORRECT
    };
    lines.extend(broken("p0 too low", off(-0.04)).into_iter().take(1));
    lines.extend(broken("p0 too high", off(0.04)).into_iter().skip(1));
    lines
}

fn anchors(problem: &Known) -> [Line; 3] {
    let alpha = 1.0 - CONFIDENCE;
    [
        Line::anchor("anchor fixed", problem, FixedDesign::new(problem, alpha)),
        Line::anchor(
            "anchor Andradottir-Kim",
            problem,
            FeasibilityCheck::new(problem, alpha),
        ),
        Line::anchor("anchor Wald", problem, Wald::new(problem, alpha)),
    ]
}

/// Measures a line.
#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 runs")]
pub(crate) fn measure(line: &Line, seed: u64, replications: u32) -> Measured {
    let place = |replication| Place {
        seed,
        replication,
        run: 0,
    };
    let outcomes = (0..replications)
        .into_par_iter()
        .map(|each| line.answer(place(each)));
    let pairs = outcomes.map(|each| (u32::from(each.is_kept), each.runs));
    let (kept, runs) = pairs.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    Measured {
        replications,
        kept,
        runs: runs as f64 / f64::from(replications),
    }
}
