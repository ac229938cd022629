use super::Reference;
use crate::requirement::problems::Known;

/// A number of runs that is fixed beforehand, with a smallest number of met ones that is enough: the
/// smallest design whose two errors are those of the sequential procedure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FixedDesign {
    runs: u64,
    enough: u64,
}

impl FixedDesign {
    /// For an allowed error of `alpha`, half of it for each side.
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
    pub(crate) fn new(problem: &Known, alpha: f64) -> Self {
        let certify = alpha / 2.0 / problem.met.len() as f64;
        let spare = problem.probability + problem.tolerance;
        let is_enough = |runs: u64| {
            let enough = quantile(runs, problem.probability, certify);
            (below(enough, runs, spare) <= alpha / 2.0).then_some(enough)
        };
        let mut high = 1;
        while is_enough(high).is_none() {
            high *= 2;
        }
        let mut low = high / 2;
        while high - low > 1 {
            let middle = u64::midpoint(low, high);
            if is_enough(middle).is_some() {
                high = middle;
            } else {
                low = middle;
            }
        }
        Self {
            runs: high,
            enough: is_enough(high).unwrap_or(high + 1),
        }
    }
}

impl Reference for FixedDesign {
    fn decide(&self, is_met: &dyn Fn(u64) -> bool) -> (bool, u64) {
        let met = (0..self.runs).filter(|run| is_met(*run)).count() as u64;
        (met >= self.enough, self.runs)
    }
}

/// The smallest count that is reached with a probability of at most `alpha`.
fn quantile(runs: u64, share: f64, alpha: f64) -> u64 {
    let mut tail = 0.0;
    for count in (0..=runs).rev() {
        tail += exactly(count, runs, share);
        if tail > alpha {
            return count + 1;
        }
    }
    0
}

/// The probability of fewer than `count` hits.
fn below(count: u64, runs: u64, share: f64) -> f64 {
    (0..count.min(runs + 1))
        .map(|hits| exactly(hits, runs, share))
        .sum()
}

#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
fn exactly(hits: u64, runs: u64, share: f64) -> f64 {
    let log_factorial = |count: u64| libm::lgamma(count as f64 + 1.0);
    let ways = log_factorial(runs) - log_factorial(hits) - log_factorial(runs - hits);
    libm::exp(ways + hits as f64 * libm::log(share) + (runs - hits) as f64 * libm::log1p(-share))
}
