//! What is measured on a line, and what passes.

use crate::binomial::lower_bound;
use crate::cases::right;
use crate::coverage::watch;
use crate::lines::{Line, Question};
use crate::play::{Played, play};
use crate::random::Place;
use rayon::prelude::*;
use std::time::Instant;

/// The confidence that every line is asked to show.
pub(crate) const CONFIDENCE: f64 = 0.95;
/// The bound of a share of correct answers is wrong with at most this probability.
const ALPHA: f64 = 0.01;
/// How far average runs may be from published ones.
const TOLERANCE: f64 = 0.02;
/// Pieces in which progress is told.
const PIECES: u32 = 50;

/// What a line came to.
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

    /// Whether the share is shown to be below the confidence; a yes about a share that is not is
    /// wrong with a probability of at most `alpha`.
    pub(crate) fn refutes(&self, alpha: f64) -> bool {
        // The upper bound of the right is what the lower bound of the wrong leaves.
        lower_bound(self.replications - self.correct, self.replications, alpha) > 1.0 - CONFIDENCE
    }

    /// Whether the line keeps what it promises.
    pub(crate) fn passes(&self, line: &Line) -> bool {
        match line.question {
            Question::Runs { expected, .. } => (self.runs / expected - 1.0).abs() <= TOLERANCE,
            Question::Selection(_) | Question::Coverage { .. } => self.lower() >= CONFIDENCE,
            Question::Unfit(_) => self.refutes(ALPHA),
        }
    }
}

/// Plays a line; `progress` hears how many macro-replications are done.
pub(crate) fn measure(
    line: &Line,
    seed: u64,
    replications: u32,
    progress: impl Fn(u32),
) -> Measured {
    let begun = Instant::now();
    let (mut correct, mut runs, mut done) = (0, 0, 0);
    let right = right(&*line.case);
    while done < replications {
        progress(done);
        let end = replications.min(done + replications.div_ceil(PIECES));
        let place = |replication| Place {
            seed,
            replication,
            run: 0,
        };
        let played = (done..end)
            .into_par_iter()
            .map(|each| answer(line, &right, place(each)));
        let count = |a: (u32, u64), b: (u32, u64)| (a.0 + b.0, a.1 + b.1);
        let pairs = played.map(|each| (u32::from(each.correct), each.runs));
        (correct, runs) = count((correct, runs), pairs.reduce(|| (0, 0), count));
        done = end;
    }
    progress(done);
    Measured {
        replications,
        correct,
        runs: average(runs, replications),
        seconds: begun.elapsed().as_secs_f64(),
    }
}

fn answer(line: &Line, right: &[bool], place: Place) -> Played {
    match line.question {
        Question::Selection(told) | Question::Unfit(told) | Question::Runs { told, .. } => {
            play(&*line.case, right, told, place)
        }
        Question::Coverage { runs } => watch(&*line.case, runs, 1.0 - CONFIDENCE, place),
    }
}

#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 runs")]
fn average(runs: u64, replications: u32) -> f64 {
    runs as f64 / f64::from(replications)
}
