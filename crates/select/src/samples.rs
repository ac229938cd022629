//! The merits recorded so far.

use crate::problem::Problem;

/// The merits of each configuration's runs 0, 1, ..., and the sums of what they are above `base`.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    /// The lowest merit that any can have: sums of differences from it keep their precision.
    base: f64,
    merits: Vec<Vec<f64>>,
    sums: Vec<f64>,
}

impl Samples {
    pub(crate) fn new(problem: &Problem) -> Self {
        let configurations = problem.configurations();
        let min = problem.bounds.iter().map(|bounds| bounds.min);
        Self {
            base: min.fold(f64::INFINITY, f64::min),
            merits: vec![Vec::new(); configurations],
            sums: vec![0.0; configurations],
        }
    }

    /// Adds rows of merits, one for each of `configurations`, all of one length.
    pub(crate) fn add(&mut self, configurations: &[usize], merits: &[f64]) {
        let runs = merits.len() / configurations.len().max(1);
        debug_assert_eq!(
            runs * configurations.len(),
            merits.len(),
            "not a row per configuration"
        );
        for (&configuration, row) in configurations.iter().zip(merits.chunks_exact(runs.max(1))) {
            self.merits[configuration].extend_from_slice(row);
            // In the order of the runs, so that the sum does not depend on how they were divided.
            for merit in row {
                self.sums[configuration] += merit - self.base;
            }
        }
    }

    pub(crate) fn of(&self, configuration: usize) -> &[f64] {
        &self.merits[configuration]
    }

    pub(crate) fn runs(&self, configuration: usize) -> usize {
        self.merits[configuration].len()
    }

    pub(crate) fn all_runs(&self) -> Vec<u64> {
        self.merits
            .iter()
            .map(|merits| merits.len() as u64)
            .collect()
    }

    /// The mean merit above the base, or minus infinity before the first run.
    #[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
    pub(crate) fn mean(&self, configuration: usize) -> f64 {
        match self.runs(configuration) {
            0 => f64::NEG_INFINITY,
            runs => self.sums[configuration] / runs as f64,
        }
    }

    /// `configurations` from the highest mean to the lowest; of equals, the first.
    pub(crate) fn by_mean(&self, configurations: &[usize]) -> Vec<usize> {
        let mut ranked = configurations.to_vec();
        ranked.sort_by(|a, b| {
            let best_first = self.mean(*b).total_cmp(&self.mean(*a));
            best_first.then(a.cmp(b))
        });
        ranked
    }
}
