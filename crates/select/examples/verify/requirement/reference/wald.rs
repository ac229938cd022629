use super::Reference;
use crate::requirement::problems::Known;

/// Wald's sequential probability ratio test of p0 + tolerance against p0 at the errors of the
/// procedure for requirements. It is the fastest test at these two probabilities.
///
/// Source: Wald (1945), Sequential tests of statistical hypotheses, Annals of Mathematical Statistics
/// 16.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wald {
    met: f64,
    missed: f64,
    feasible: f64,
    infeasible: f64,
}

impl Wald {
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
    pub(crate) fn new(problem: &Known, alpha: f64) -> Self {
        let (low, high) = (problem.probability, problem.probability + problem.tolerance);
        let (certify, refute) = (alpha / 2.0 / problem.met.len() as f64, alpha / 2.0);
        Self {
            met: libm::log(high / low),
            missed: libm::log((1.0 - high) / (1.0 - low)),
            feasible: libm::log((1.0 - refute) / certify),
            infeasible: libm::log(refute / (1.0 - certify)),
        }
    }
}

impl Reference for Wald {
    fn decide(&self, is_met: &dyn Fn(u64) -> bool) -> (bool, u64) {
        let (mut ratio, mut runs) = (0.0, 0);
        while ratio < self.feasible && ratio > self.infeasible {
            ratio += if is_met(runs) { self.met } else { self.missed };
            runs += 1;
        }
        (ratio > 0.0, runs)
    }
}
