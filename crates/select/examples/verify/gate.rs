//! What is measured on a line, and what passes.

use crate::binomial::lower_bound;
use crate::cases::right;
use crate::coverage::check;
use crate::lines::{Line, Question};
use crate::random::Place;
use crate::selection::{CONFIDENCE, Outcome, select};
use rayon::prelude::*;
use std::time::Instant;

/// The bound of a share of correct answers is wrong with at most this probability.
const ALPHA: f64 = 0.01;
/// How far average runs may be from published ones.
const TOLERANCE: f64 = 0.02;
/// Steps in which progress is reported.
const STEPS: u32 = 50;

/// The result of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    pub(crate) replications: u32,
    pub(crate) correct: u32,
    /// On average, of all configurations together.
    pub(crate) runs: f64,
    pub(crate) seconds: f64,
}

impl Measured {
    /// Share of correct answers.
    pub(crate) fn share(&self) -> f64 {
        f64::from(self.correct) / f64::from(self.replications)
    }

    /// 99% lower bound of that share.
    pub(crate) fn lower(&self) -> f64 {
        lower_bound(self.correct, self.replications, ALPHA)
    }

    /// Whether the share is proved to be below the confidence; `true` is wrong with a probability of
    /// at most `alpha`.
    pub(crate) fn refutes(&self, alpha: f64) -> bool {
        // The upper bound of the correct share is 1 minus the lower bound of the wrong share.
        lower_bound(self.replications - self.correct, self.replications, alpha) > 1.0 - CONFIDENCE
    }

    /// Whether the line passes.
    pub(crate) fn passes(&self, line: &Line) -> bool {
        match line.question {
            Question::Runs { expected, .. } => (self.runs / expected - 1.0).abs() <= TOLERANCE,
            Question::Selection(_) | Question::Coverage { .. } => self.lower() >= CONFIDENCE,
            Question::Unfit(_) => self.refutes(ALPHA),
        }
    }
}

/// Measures a line; `progress` is called with the number of macro-replications done.
pub(crate) fn measure(
    line: &Line,
    seed: u64,
    replications: u32,
    progress: impl Fn(u32),
) -> Measured {
    let start = Instant::now();
    let (mut correct, mut runs, mut done) = (0, 0, 0);
    let right = right(&*line.case);
    while done < replications {
        progress(done);
        let end = replications.min(done + replications.div_ceil(STEPS));
        let place = |replication| Place {
            seed,
            replication,
            run: 0,
        };
        let outcomes = (done..end)
            .into_par_iter()
            .map(|each| answer(line, &right, place(each)));
        let count = |a: (u32, u64), b: (u32, u64)| (a.0 + b.0, a.1 + b.1);
        let pairs = outcomes.map(|each| (u32::from(each.correct), each.runs));
        (correct, runs) = count((correct, runs), pairs.reduce(|| (0, 0), count));
        done = end;
    }
    progress(done);
    Measured {
        replications,
        correct,
        runs: average(runs, replications),
        seconds: start.elapsed().as_secs_f64(),
    }
}

fn answer(line: &Line, right: &[bool], place: Place) -> Outcome {
    match line.question {
        Question::Selection(setup) | Question::Unfit(setup) | Question::Runs { setup, .. } => {
            select(&*line.case, right, setup, place)
        }
        Question::Coverage { runs } => check(&*line.case, runs, 1.0 - CONFIDENCE, place),
    }
}

#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 runs")]
fn average(runs: u64, replications: u32) -> f64 {
    runs as f64 / f64::from(replications)
}
