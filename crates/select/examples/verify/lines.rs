//! What is measured.

use crate::cases::{Capped, Case, Failures, Hills, Lottery, Normal, Teams};
use crate::reference::rinott_h;
use crate::selection::{Batches, CONFIDENCE, Method, Setup};

/// One line of the table.
pub(crate) struct Line {
    /// What is measured: `race`, `strict`, `bounds`, `Rinott`, `KN`, `equal`.
    pub(crate) subject: &'static str,
    pub(crate) problem: String,
    pub(crate) case: Box<dyn Case>,
    pub(crate) question: Question,
    pub(crate) replications: u32,
    /// Average runs measured elsewhere, for comparison.
    pub(crate) published_runs: Option<f64>,
}

/// The property of a case that is verified.
#[derive(Clone, Copy)]
pub(crate) enum Question {
    /// Is the right configuration selected?
    Selection(Setup),
    /// Do the bounds of all means hold for this number of runs per configuration?
    Coverage { runs: usize },
    /// Is a wrong configuration selected too often? For procedures that are unfit or broken on
    /// purpose.
    Unfit(Setup),
    /// Does selecting take as many runs as published?
    Runs { setup: Setup, expected: f64 },
}

/// Macro-replications of a line.
const MANY: u32 = 20_000;
/// Of a line that would take minutes with that many.
const FEW: u32 = 1000;

impl Line {
    /// A selection with the correct setup.
    pub(crate) fn new(problem: &str, method: Method, case: impl Case + 'static) -> Self {
        Self {
            subject: method.name(),
            problem: problem.to_owned(),
            case: Box::new(case),
            question: Question::Selection(Setup::correct(method)),
            replications: MANY,
            published_runs: None,
        }
    }

    fn in_batches(self, batches: Batches) -> Self {
        self.breaking(|setup| setup.batches = batches)
    }

    /// The same line with a changed setup.
    pub(crate) fn breaking(mut self, change: impl Fn(&mut Setup)) -> Self {
        if let Question::Selection(setup) | Question::Unfit(setup) = &mut self.question {
            change(setup);
        }
        self
    }

    fn unfit(mut self) -> Self {
        if let Question::Selection(setup) = self.question {
            self.question = Question::Unfit(setup);
        }
        self
    }

    fn few(mut self) -> Self {
        self.replications = FEW;
        self
    }

    /// Whether its name contains these words.
    pub(crate) fn is_named(&self, words: &str) -> bool {
        format!("{} {}", self.subject, self.problem).contains(words)
    }
}

/// All lines, in the table's order.
pub(crate) fn all() -> Vec<Line> {
    let mut lines = race();
    lines.extend(selections(Method::Strict));
    lines.extend(coverage());
    lines.extend(references());
    lines.extend(unfit());
    lines
}

/// The lines of the race, with the average runs that other implementations of it needed.
fn race() -> Vec<Line> {
    let published = [
        ("failures .002 and .004", 47_264.0),
        ("failures .01 and .02", 9124.0),
        ("failures .1 and .2", 824.0),
        ("40 teams", 54_533.0),
        ("40 teams, common numbers", 8425.0),
        ("1000 teams", 921_730.0),
    ];
    let mut lines = selections(Method::Race);
    for line in &mut lines {
        let same = published.iter().find(|(name, _)| *name == line.problem);
        line.published_runs = same.map(|(_, runs)| *runs);
    }
    lines
}

/// A procedure on all cases, and on the hardest ones in batches that it does not request.
pub(crate) fn selections(method: Method) -> Vec<Line> {
    let random = Batches::Random(50);
    vec![
        Line::new("slippage", method, Hills::slippage()),
        Line::new("equally spaced means", method, Hills::spaced()),
        Line::new("crowded means", method, Hills::crowded()),
        Line::new("equal means", method, Hills::equal()),
        Line::new("unequal variances", method, Hills::unequal()),
        Line::new("failures .002 and .004", method, failures(0.004)),
        Line::new("failures .01 and .02", method, failures(0.02)),
        Line::new("failures .1 and .2", method, failures(0.2)),
        Line::new("failures .1 and .2, two only", method, two_failures(0.2)),
        Line::new("a win in 50 runs", method, Lottery),
        Line::new("times with a cap", method, Capped::new()),
        Line::new("40 teams", method, Teams::sizes(false)),
        Line::new("40 teams, common numbers", method, Teams::sizes(true)),
        Line::new("1000 teams", method, Teams::mixes(25, false)).few(),
        Line::new("1000 teams, common numbers", method, Teams::mixes(25, true)).few(),
        Line::new("slippage, random batches", method, Hills::slippage()).in_batches(random),
        Line::new("failures .1 and .2, random batches", method, failures(0.2)).in_batches(random),
        Line::new("slippage, run by run", method, Hills::slippage()).in_batches(Batches::Single),
        Line::new("failures .1 and .2, run by run", method, failures(0.2))
            .in_batches(Batches::Single),
        Line::new("two only, run by run", method, two_failures(0.2)).in_batches(Batches::Single),
        Line::new("a win in 50 runs, run by run", method, Lottery).in_batches(Batches::Single),
    ]
}

/// Ten configurations.
pub(crate) fn failures(others: f64) -> Failures {
    Failures {
        configurations: 10,
        others,
    }
}

fn two_failures(other: f64) -> Failures {
    Failures {
        configurations: 2,
        others: other,
    }
}

/// What must be found unfit; otherwise the gate would not notice errors.
pub(crate) fn unfit() -> Vec<Line> {
    let kn = Method::KimNelson { first_runs: 24 };
    let published = |runs, line: Line| Line {
        published_runs: Some(runs),
        ..line.unfit()
    };
    let mut lines = vec![
        published(
            400.0,
            Line::new("40 teams", Method::Equal { runs: 10 }, Teams::sizes(false)),
        ),
        published(
            18_134.0,
            Line::new("failures .01 and .02", kn, failures(0.02)),
        ),
        published(901.0, Line::new("failures .1 and .2", kn, failures(0.2))),
    ];
    for method in [Method::Race, Method::Strict] {
        let large_alpha = Line::new("ten times alpha", method, failures(0.2)).unfit();
        let large_delta = Line::new("twice delta", method, failures(0.2)).unfit();
        lines.push(large_alpha.breaking(|setup| setup.confidence = 0.5));
        lines.push(large_delta.breaking(|setup| setup.deltas = 2.0));
    }
    lines
}

/// The bounds of all means of a case together.
pub(crate) fn coverage() -> Vec<Line> {
    let line = |problem: &str, case| Line {
        subject: "bounds",
        problem: problem.to_owned(),
        case,
        question: Question::Coverage { runs: 500 },
        replications: MANY,
        published_runs: None,
    };
    vec![
        line("failures .002 and .004", Box::new(failures(0.004))),
        line("failures .1 and .2", Box::new(failures(0.2))),
        line("a win in 50 runs", Box::new(Lottery)),
        line("unequal variances", Box::new(Hills::unequal())),
        line("times with a cap", Box::new(Capped::new())),
    ]
}

/// The reference procedures on normal merits, against the average runs published for them:
/// configurations, runs of the first stage, and the average for slippage or equally spaced means.
pub(crate) fn references() -> Vec<Line> {
    let mut lines = Vec::new();
    for (k, first_runs, slippage, spaced) in [
        (10, 10, 1848.0, None),
        (10, 24, 3509.0, None),
        (100, 10, 36_207.0, Some(36_207.0)),
    ] {
        let h = rinott_h(k as usize, u64::from(first_runs), CONFIDENCE);
        let rinott = Method::Rinott { first_runs, h };
        lines.extend(reference(rinott, (k, first_runs, 0.0), slippage, spaced));
    }
    for (k, first_runs, correlation, slippage, spaced) in [
        (10, 10, 0.0, 977.0, None),
        (10, 24, 0.0, 1738.0, None),
        (100, 10, 0.0, 13_671.0, Some(1847.0)),
        (10, 10, 0.75, 256.0, None),
        (10, 24, 0.75, 454.0, None),
        (100, 10, 0.75, 3538.0, Some(1139.0)),
    ] {
        let kn = Method::KimNelson { first_runs };
        lines.extend(reference(
            kn,
            (k, first_runs, correlation),
            slippage,
            spaced,
        ));
    }
    lines
}

/// `setting`: configurations, runs of the first stage, correlation.
fn reference(
    method: Method,
    setting: (u32, u32, f64),
    slippage: f64,
    spaced: Option<f64>,
) -> impl Iterator<Item = Line> {
    let (k, first_runs, correlation) = setting;
    let common = if correlation > 0.0 {
        ", common numbers"
    } else {
        ""
    };
    let name = move |means| format!("k={k} {means} n0={first_runs}{common}");
    let line = move |case: Normal, means, expected| Line {
        question: Question::Runs {
            setup: Setup::correct(method),
            expected,
        },
        // Enough for an average that is accurate to half a percent.
        replications: if k > 10 { FEW } else { MANY / 2 },
        published_runs: Some(expected),
        ..Line::new(&name(means), method, case)
    };
    let slippage = line(
        Normal::slippage(k, first_runs, correlation),
        "slippage",
        slippage,
    );
    let spaced =
        spaced.map(|runs| line(Normal::spaced(k, first_runs, correlation), "spaced", runs));
    std::iter::once(slippage).chain(spaced)
}
