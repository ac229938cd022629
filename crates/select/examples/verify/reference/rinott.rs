//! Rinott's two-stage procedure, and its constant by quadrature.

use super::normal;
use super::tally::{Tally, as_f64};
use select::{Elimination, Procedure, Request};

/// Rinott's procedure: the variances of a first stage determine how many runs each configuration
/// needs, `N_i = max(n0, ceil(h^2 S_i^2 / delta^2))`; the best mean of all runs is chosen.
///
/// Guarantee: if merits are normal and independent between configurations, and the best mean is
/// at least `delta` above every other, it is chosen with at least the stated confidence.
///
/// Source: Rinott, *On two-stage selection procedures and related probability-inequalities*,
/// Communications in Statistics A7 (1978).
#[derive(Debug, Clone)]
pub(crate) struct Rinott {
    tally: Tally,
    /// `h / delta`.
    scale: f64,
    first_runs: u64,
    /// Runs that each configuration needs: `first_runs` until the first stage is over.
    needed: Vec<u64>,
}

impl Rinott {
    /// For `configurations >= 1`, a `delta > 0` in units of merit, the constant `h` of [`rinott_h`],
    /// and `first_runs >= 2` runs per configuration in the first stage (ten or more are
    /// recommended: fewer make the second stage long).
    #[must_use]
    pub(crate) fn new(configurations: usize, delta: f64, h: f64, first_runs: u64) -> Self {
        debug_assert!(configurations >= 1 && delta > 0.0 && first_runs >= 2);
        Self {
            tally: Tally::new(configurations),
            scale: h / delta,
            first_runs,
            needed: vec![first_runs; configurations],
        }
    }

    fn plan_second_stage(&mut self) {
        for (configuration, needed) in self.needed.iter_mut().enumerate() {
            let runs = self.scale * self.scale * self.tally.variance(configuration);
            *needed = self.first_runs.max(runs_from(runs));
        }
    }

    fn missing(&self, configuration: usize) -> u64 {
        self.needed[configuration] - self.tally.runs[configuration]
    }
}

/// Maximum number of runs per configuration in one request, so that they fit in memory.
const MAX_RUNS: usize = 1 << 14;

/// Whole runs that are at least `runs`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and a float too great becomes the greatest integer"
)]
fn runs_from(runs: f64) -> u64 {
    runs.ceil() as u64
}

impl Procedure for Rinott {
    /// All that need more runs continue together until the first of them has enough.
    fn next(&self) -> Option<Request> {
        let configurations: Vec<usize> = (0..self.needed.len())
            .filter(|&each| self.missing(each) > 0)
            .collect();
        let missing = configurations
            .iter()
            .map(|&each| self.missing(each))
            .min()?;
        Some(Request {
            first_run: self.tally.runs[configurations[0]],
            runs: usize::try_from(missing).unwrap_or(usize::MAX).min(MAX_RUNS),
            configurations,
        })
    }

    fn record(&mut self, merits: &[f64]) {
        let Some(request) = self.next() else { return };
        self.tally.record(&request, merits);
        if self.tally.runs[0] == self.first_runs && request.first_run < self.first_runs {
            self.plan_second_stage();
        }
    }

    fn selected(&self) -> Option<usize> {
        Some(self.tally.best())
    }

    fn runs(&self) -> Vec<u64> {
        self.tally.runs.clone()
    }

    /// All, to the end.
    fn survivors(&self) -> Vec<usize> {
        (0..self.tally.runs.len()).collect()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        Vec::new()
    }
}

/// Rinott's constant h, to about nine decimals: the root of
///
/// ```text
/// E_Y [ E_X [ Phi( h / sqrt(v (1/X + 1/Y)) ) ]^(k-1) ] = confidence,
/// ```
///
/// X and Y chi-square with `v = first_runs - 1` degrees of freedom. For `configurations >= 1`
/// (k; 0 for one), `first_runs >= 2` and a `confidence` from 0.5 to below 1.
#[must_use]
pub(crate) fn rinott_h(configurations: usize, first_runs: u64, confidence: f64) -> f64 {
    debug_assert!(configurations >= 1 && first_runs >= 2);
    debug_assert!((0.5..1.0).contains(&confidence));
    if configurations == 1 {
        return 0.0;
    }
    let freedom = as_f64(first_runs - 1);
    let nodes = chi_square_nodes(freedom);
    let rivals = as_f64(configurations as u64 - 1);
    root(|h| chance_of_best(h, rivals, freedom, &nodes) - confidence)
}

/// A value of a random variable and its probability.
type Node = (f64, f64);

/// Steps of the quadrature to either side of the middle.
const STEPS: i32 = 100;
/// Logarithm of the least density, relative to the greatest, that is not left out.
const MIN_LOG_DENSITY: f64 = -40.0;

/// Nodes for a chi-square variable X: the trapezoid rule in `ln X`, whose density is smooth and
/// falls off at least exponentially to both sides, so that the rule converges exponentially.
fn chi_square_nodes(freedom: f64) -> Vec<Node> {
    // The density of t = ln(X / freedom), relative to its greatest value, at t = 0.
    let log_density = |t: f64| freedom / 2.0 * (t - libm::expm1(t));
    let width = |sign: f64| sign * root(|t| MIN_LOG_DENSITY.abs() + log_density(sign * t));
    let (least, greatest) = (width(-1.0), width(1.0));
    let step = (greatest - least) / f64::from(2 * STEPS);
    let nodes: Vec<Node> = (0..=2 * STEPS)
        .map(|place| least + f64::from(place) * step)
        .map(|t| (freedom * libm::exp(t), libm::exp(log_density(t))))
        .collect();
    let sum: f64 = nodes.iter().map(|(_, weight)| weight).sum();
    nodes.iter().map(|(x, weight)| (*x, weight / sum)).collect()
}

/// The chance that the best of a least favourable set wins against all its rivals.
fn chance_of_best(h: f64, rivals: f64, freedom: f64, nodes: &[Node]) -> f64 {
    let against_one = |y: f64| -> f64 {
        let wins = |x: f64| normal::cdf(h / (freedom * (1.0 / x + 1.0 / y)).sqrt());
        nodes.iter().map(|(x, weight)| weight * wins(*x)).sum()
    };
    let against_all = |y: f64| libm::pow(against_one(y), rivals);
    nodes
        .iter()
        .map(|(y, weight)| weight * against_all(*y))
        .sum()
}

/// Where a monotone function of a positive number changes its sign, by bisection.
fn root(function: impl Fn(f64) -> f64) -> f64 {
    let sign = function(0.0) > 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    while (function(high) > 0.0) == sign && high < f64::MAX / 2.0 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..40 {
        let middle = low + (high - low) / 2.0;
        if (function(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_those_of_the_tables() {
        let table = [
            (2, 20, 2.452),
            (10, 10, 4.290),
            (10, 20, 3.875),
            (100, 20, 5.184),
            (1000, 50, 5.786),
        ];
        for (configurations, first_runs, expected) in table {
            let h = rinott_h(configurations, first_runs, 0.95);
            assert!(
                (h - expected).abs() < 6e-4,
                "{configurations} {first_runs}: {h}"
            );
        }
    }

    #[test]
    fn constant_of_two_with_two_first_runs_is_a_cauchy_quantile() {
        // Z / |A| is Cauchy for normal Z and A, and so is half the sum of two of them.
        for (confidence, tangent) in [(0.75, 1.0), (5.0 / 6.0, 3.0_f64.sqrt())] {
            let h = rinott_h(2, 2, confidence);
            assert!((h - 2.0 * tangent).abs() < 1e-8, "{h}");
        }
    }

    #[test]
    fn constant_grows_with_confidence_and_rivals_and_falls_with_first_runs() {
        let h = rinott_h(10, 10, 0.95);
        assert!(rinott_h(10, 10, 0.99) > h && rinott_h(20, 10, 0.95) > h);
        assert!(rinott_h(10, 30, 0.95) < h);
        assert!(rinott_h(1, 10, 0.95).abs() < f64::EPSILON);
    }

    #[test]
    fn a_noisier_configuration_gets_more_runs_and_one_without_noise_the_first_stage() {
        let mut procedure = Rinott::new(2, 0.5, rinott_h(2, 10, 0.95), 10);
        while let Some(request) = procedure.next() {
            let row = |&each: &usize| {
                let numbers = request.first_run..request.first_run + request.runs as u64;
                let noise = |run: u64| if run.is_multiple_of(2) { 1.0 } else { -1.0 };
                numbers
                    .map(move |run| [1.0, 0.0][each] * noise(run))
                    .collect::<Vec<_>>()
            };
            procedure.record(
                &request
                    .configurations
                    .iter()
                    .flat_map(row)
                    .collect::<Vec<_>>(),
            );
        }
        let expected = (rinott_h(2, 10, 0.95) / 0.5).powi(2) * 10.0 / 9.0;
        assert_eq!(procedure.runs(), [runs_from(expected), 10]);
    }
}
