use super::Reference;
use crate::requirement::problems::Known;

/// Runs of the first stage.
const FIRST: u64 = 20;

/// The fully sequential feasibility check for one constraint, which assumes normal observations.
///
/// Source: Andradóttir and Kim (2010), Fully sequential procedures for comparing constrained systems
/// via simulation, Naval Research Logistics 57, section 3, with c = 1. Batur and Kim (2010), Finding
/// feasible systems in the presence of constraints on multiple performance measures, ACM TOMACS 20(3),
/// reduces to it for a single constraint.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FeasibilityCheck {
    /// In the middle between what must and what need not be found feasible.
    limit: f64,
    half_tolerance: f64,
    h_squared: f64,
}

impl FeasibilityCheck {
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
    pub(crate) fn new(problem: &Known, alpha: f64) -> Self {
        let half_tolerance = problem.tolerance / 2.0;
        let error = alpha / problem.met.len() as f64;
        let degrees = (FIRST - 1) as f64;
        let eta = (libm::pow(2.0 * error, -2.0 / degrees) - 1.0) / 2.0;
        Self {
            limit: problem.probability + half_tolerance,
            half_tolerance,
            h_squared: 2.0 * eta * degrees,
        }
    }
}

impl Reference for FeasibilityCheck {
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53")]
    fn decide(&self, is_met: &dyn Fn(u64) -> bool) -> (bool, u64) {
        let mut met = (0..FIRST).filter(|run| is_met(*run)).count() as f64;
        let first = FIRST as f64;
        let variance = met * (first - met) / (first * (first - 1.0));
        let start = self.h_squared * variance / (2.0 * self.half_tolerance);
        let mut runs = FIRST;
        loop {
            let sum = met - self.limit * runs as f64;
            let width = (start - self.half_tolerance / 2.0 * runs as f64).max(0.0);
            if sum.abs() >= width {
                return (sum >= 0.0, runs);
            }
            met += f64::from(u8::from(is_met(runs)));
            runs += 1;
        }
    }
}
