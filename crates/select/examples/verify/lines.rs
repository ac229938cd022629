//! What is measured.

use crate::cases::{Capped, Case, Failures, Hills, Normal, Teams};
use crate::gate::CONFIDENCE;
use crate::play::{Batches, Method, Told};

/// One line of the table.
pub(crate) struct Line {
    /// Who answers: `race`, `strict`, `bounds`, `Rinott`, `KN`.
    pub(crate) who: &'static str,
    pub(crate) problem: &'static str,
    pub(crate) case: Box<dyn Case>,
    pub(crate) question: Question,
    pub(crate) replications: u32,
    /// Average runs measured elsewhere, to compare with.
    pub(crate) published_runs: Option<f64>,
}

/// What is asked about a case.
#[derive(Clone, Copy)]
pub(crate) enum Question {
    /// Is the right configuration selected?
    Selection(Told),
    /// Do the bounds of all means hold for so many runs of each?
    Coverage { runs: usize },
    /// Does selecting take as many runs as published?
    Runs { told: Told, expected: f64 },
}

impl Line {
    /// Whether its name has these words in it.
    pub(crate) fn is_named(&self, words: &str) -> bool {
        format!("{} {}", self.who, self.problem).contains(words)
    }
}

/// A case by name: (name, case, macro-replications of the race, of the strict one, published runs
/// of the race).
type Row = (&'static str, Box<dyn Case>, u32, u32, Option<f64>);

/// Macro-replications of a line, unless that would take more than a couple of minutes.
const MANY: u32 = 20_000;

/// All lines, in the table's order.
pub(crate) fn all() -> Vec<Line> {
    let mut lines = selections("race", Method::Race);
    lines.extend(selections("strict", Method::Strict));
    lines.extend(coverage());
    lines.extend(references());
    lines
}

fn rows() -> Vec<Row> {
    vec![
        ("slippage", Box::new(Hills::slippage()), MANY, MANY, None),
        (
            "equally spaced means",
            Box::new(Hills::spaced()),
            MANY,
            MANY,
            None,
        ),
        (
            "crowded means",
            Box::new(Hills::crowded()),
            MANY,
            MANY,
            None,
        ),
        ("equal means", Box::new(Hills::equal()), MANY, MANY, None),
        (
            "unequal variances",
            Box::new(Hills::unequal()),
            MANY,
            MANY,
            None,
        ),
        (
            "failures .002 and .004",
            failures(0.004),
            MANY,
            MANY,
            Some(47_264.0),
        ),
        (
            "failures .01 and .02",
            failures(0.02),
            MANY,
            MANY,
            Some(9124.0),
        ),
        ("failures .1 and .2", failures(0.2), MANY, MANY, Some(824.0)),
        (
            "times with a cap",
            Box::new(Capped::new()),
            MANY,
            MANY,
            None,
        ),
        (
            "40 teams",
            Box::new(Teams::sizes(false)),
            MANY,
            MANY,
            Some(54_533.0),
        ),
        (
            "40 teams, common numbers",
            Box::new(Teams::sizes(true)),
            MANY,
            MANY,
            Some(8425.0),
        ),
        (
            "1000 teams",
            Box::new(Teams::mixes(25, false)),
            200,
            200,
            Some(921_730.0),
        ),
        (
            "1000 teams, common numbers",
            Box::new(Teams::mixes(25, true)),
            200,
            200,
            None,
        ),
    ]
}

fn failures(others: f64) -> Box<dyn Case> {
    Box::new(Failures { others })
}

/// A procedure on all cases, and on one with other batches than it asks for.
fn selections(who: &'static str, method: Method) -> Vec<Line> {
    let line = |(problem, case, race, strict, published_runs): Row, batches| Line {
        who,
        problem,
        case,
        question: Question::Selection(told(method, batches)),
        replications: if method == Method::Race { race } else { strict },
        published_runs: published_runs.filter(|_| method == Method::Race),
    };
    let mut lines: Vec<Line> = rows()
        .into_iter()
        .map(|row| line(row, Batches::Asked))
        .collect();
    let batches = (
        "failures .1 and .2, random batches",
        failures(0.2),
        MANY,
        MANY,
        None,
    );
    lines.push(line(batches, Batches::Random(50)));
    let single = (
        "failures .1 and .2, run by run",
        failures(0.2),
        MANY,
        MANY,
        None,
    );
    lines.push(line(single, Batches::Single));
    let single = (
        "slippage, run by run",
        Box::new(Hills::slippage()) as Box<dyn Case>,
        MANY,
        MANY,
        None,
    );
    lines.push(line(single, Batches::Single));
    lines
}

/// What a procedure is told when nothing is broken.
pub(crate) fn told(method: Method, batches: Batches) -> Told {
    Told {
        method,
        batches,
        confidence: CONFIDENCE,
        deltas: 1.0,
    }
}

fn coverage() -> Vec<Line> {
    let line = |(problem, case): (&'static str, Box<dyn Case>)| Line {
        who: "bounds",
        problem,
        case,
        question: Question::Coverage { runs: 500 },
        replications: MANY,
        published_runs: None,
    };
    let cases: Vec<(&'static str, Box<dyn Case>)> = vec![
        ("failures .002 and .004", failures(0.004)),
        ("failures .1 and .2", failures(0.2)),
        ("unequal variances", Box::new(Hills::unequal())),
        ("times with a cap", Box::new(Capped::new())),
    ];
    cases.into_iter().map(line).collect()
}

/// The reference procedures on normal merits, against the average runs published for them.
pub(crate) fn references() -> Vec<Line> {
    let slippage =
        |k, first_runs, correlation| Box::new(Normal::slippage(k, first_runs, correlation));
    let spaced = |k, first_runs, correlation| Box::new(Normal::spaced(k, first_runs, correlation));
    let rinott = |first_runs| Method::Rinott { first_runs };
    let kn = |first_runs| Method::KimNelson { first_runs };
    vec![
        reference(
            "k=10 slippage n0=10",
            slippage(10, 10, 0.0),
            rinott(10),
            1848.0,
        ),
        reference(
            "k=10 slippage n0=24",
            slippage(10, 24, 0.0),
            rinott(24),
            3509.0,
        ),
        reference(
            "k=100 slippage n0=10",
            slippage(100, 10, 0.0),
            rinott(10),
            36_207.0,
        ),
        reference(
            "k=100 spaced n0=10",
            spaced(100, 10, 0.0),
            rinott(10),
            36_207.0,
        ),
        reference("k=10 slippage n0=10", slippage(10, 10, 0.0), kn(10), 977.0),
        reference("k=10 slippage n0=24", slippage(10, 24, 0.0), kn(24), 1738.0),
        reference(
            "k=100 slippage n0=10",
            slippage(100, 10, 0.0),
            kn(10),
            13_671.0,
        ),
        reference("k=100 spaced n0=10", spaced(100, 10, 0.0), kn(10), 1847.0),
        reference(
            "k=10 slippage n0=10, common numbers",
            slippage(10, 10, 0.75),
            kn(10),
            256.0,
        ),
        reference(
            "k=10 slippage n0=24, common numbers",
            slippage(10, 24, 0.75),
            kn(24),
            454.0,
        ),
        reference(
            "k=100 slippage n0=10, common numbers",
            slippage(100, 10, 0.75),
            kn(10),
            3538.0,
        ),
        reference(
            "k=100 spaced n0=10, common numbers",
            spaced(100, 10, 0.75),
            kn(10),
            1139.0,
        ),
    ]
}

fn reference(problem: &'static str, case: Box<Normal>, method: Method, expected: f64) -> Line {
    Line {
        who: if matches!(method, Method::Rinott { .. }) {
            "Rinott"
        } else {
            "KN"
        },
        problem,
        // The average needs no more to be good to half a per cent.
        replications: if case.means().len() > 10 {
            1000
        } else {
            10_000
        },
        case,
        question: Question::Runs {
            told: told(method, Batches::Asked),
            expected,
        },
        published_runs: Some(expected),
    }
}
