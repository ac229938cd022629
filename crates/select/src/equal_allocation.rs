//! Equal allocation: a fixed number of runs per configuration; the best mean is selected.

use crate::procedure::{Elimination, Exclude, Procedure, Request};

/// Maximum number of runs in one request, of all its configurations together, so that they fit in
/// memory.
const MAX_ROWS: usize = 1 << 20;

/// The same number of runs per configuration, as in the 2003 experiment with its ten runs.
///
/// It gives no guarantee, and eliminates no configuration. Merits need no bounds.
#[derive(Debug, Clone)]
pub struct EqualAllocation {
    means: Vec<f64>,
    /// The configurations that run, ascending.
    configurations: Vec<usize>,
    runs: u64,
    recorded: u64,
}

impl EqualAllocation {
    /// For `configurations >= 1` with `runs >= 1` runs per configuration.
    #[must_use]
    pub fn new(configurations: usize, runs: u64) -> Self {
        debug_assert!(configurations >= 1 && runs >= 1);
        Self {
            means: vec![0.0; configurations],
            configurations: (0..configurations).collect(),
            runs,
            recorded: 0,
        }
    }
}

impl Procedure for EqualAllocation {
    fn next(&self) -> Option<Request> {
        let max_runs = (MAX_ROWS / self.means.len()).max(1);
        let missing = usize::try_from(self.runs - self.recorded).unwrap_or(max_runs);
        (missing > 0).then(|| Request {
            configurations: self.configurations.clone(),
            first_run: self.recorded,
            runs: missing.min(max_runs),
        })
    }

    #[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
    fn record(&mut self, merits: &[f64]) {
        let Some(request) = self.next() else { return };
        for (&each, row) in self
            .configurations
            .iter()
            .zip(merits.chunks_exact(request.runs))
        {
            let mean = &mut self.means[each];
            let counts = self.recorded + 1..;
            for (merit, count) in row.iter().zip(counts) {
                *mean += (merit - *mean) / count as f64;
            }
        }
        self.recorded += request.runs as u64;
    }

    /// The first of those with the greatest mean.
    fn selected(&self) -> Option<usize> {
        let mut configurations = self.configurations.iter().copied();
        let first = configurations.next()?;
        Some(configurations.fold(first, |best, each| {
            if self.means[each] > self.means[best] {
                each
            } else {
                best
            }
        }))
    }

    fn runs(&self) -> Vec<u64> {
        let mut runs = vec![0; self.means.len()];
        for &each in &self.configurations {
            runs[each] = self.recorded;
        }
        runs
    }

    fn survivors(&self) -> Vec<usize> {
        self.configurations.clone()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        Vec::new()
    }
}

impl Exclude for EqualAllocation {
    fn exclude(&mut self, configurations: &[usize]) {
        self.configurations
            .retain(|each| !configurations.contains(each));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_configurations_get_the_same_runs_and_the_best_mean_is_selected() {
        let mut equal = EqualAllocation::new(3, 2_500_000);
        let mut recorded = 0;
        while let Some(request) = equal.next() {
            assert_eq!(request.first_run, recorded);
            recorded += request.runs as u64;
            let row = |configuration: &usize| vec![[1.0, 3.0, 2.0][*configuration]; request.runs];
            let merits: Vec<f64> = request.configurations.iter().flat_map(row).collect();
            equal.record(&merits);
        }
        assert_eq!(equal.runs(), [2_500_000; 3]);
        assert_eq!(equal.selected(), Some(1));
    }
}
