//! Running counts, means and variances of every configuration.

use select::Request;

/// Running moments of each configuration, by Welford's method.
///
/// Source: Welford, *Note on a method for calculating corrected sums of squares and products*,
/// Technometrics 4 (1962).
#[derive(Debug, Clone)]
pub(super) struct Tally {
    pub(super) runs: Vec<u64>,
    pub(super) means: Vec<f64>,
    squares: Vec<f64>,
}

impl Tally {
    pub(super) fn new(configurations: usize) -> Self {
        Self {
            runs: vec![0; configurations],
            means: vec![0.0; configurations],
            squares: vec![0.0; configurations],
        }
    }

    /// Adds the merits of `request`, row-major `(configurations, runs)`.
    pub(super) fn record(&mut self, request: &Request, merits: &[f64]) {
        debug_assert_eq!(merits.len(), request.configurations.len() * request.runs);
        let rows = merits.chunks_exact(request.runs);
        for (&configuration, row) in request.configurations.iter().zip(rows) {
            for &merit in row {
                self.add(configuration, merit);
            }
        }
    }

    fn add(&mut self, configuration: usize, merit: f64) {
        self.runs[configuration] += 1;
        let deviation = merit - self.means[configuration];
        self.means[configuration] += deviation / as_f64(self.runs[configuration]);
        self.squares[configuration] += deviation * (merit - self.means[configuration]);
    }

    /// Unbiased variance of a configuration's merits; requires two runs.
    pub(super) fn variance(&self, configuration: usize) -> f64 {
        self.squares[configuration] / as_f64(self.runs[configuration] - 1)
    }

    /// The first of those with the greatest mean.
    pub(super) fn best(&self) -> usize {
        first_greatest(&self.means)
    }
}

/// Index of the first of the greatest values; 0 if there is none.
pub(super) fn first_greatest(values: &[f64]) -> usize {
    (0..values.len()).fold(0, |best, each| {
        if values[each] > values[best] {
            each
        } else {
            best
        }
    })
}

/// A count as a number: exact below 2^53.
#[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
pub(super) fn as_f64(count: u64) -> f64 {
    count as f64
}
