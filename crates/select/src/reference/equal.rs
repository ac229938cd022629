//! Equal allocation: the same number of runs of every configuration; the best mean is chosen.

use super::runs_to_ask;
use super::tally::Tally;
use crate::procedure::{Elimination, Procedure, Request};

/// A fixed number of runs of each configuration, as the thesis did with ten runs a team.
///
/// It gives no guarantee. Merits need no bounds and no normality.
#[derive(Debug, Clone)]
pub struct Equal {
    tally: Tally,
    runs: u64,
}

impl Equal {
    /// For `configurations >= 1` with `runs >= 1` runs of each.
    #[must_use]
    pub fn new(configurations: usize, runs: u64) -> Self {
        debug_assert!(configurations >= 1 && runs >= 1);
        Self {
            tally: Tally::new(configurations),
            runs,
        }
    }
}

impl Procedure for Equal {
    fn next(&self) -> Option<Request> {
        let first_run = self.tally.runs[0];
        (first_run < self.runs).then(|| Request {
            configurations: (0..self.tally.runs.len()).collect(),
            first_run,
            runs: runs_to_ask(self.runs - first_run, self.tally.runs.len()),
        })
    }

    fn tell(&mut self, merits: &[f64]) {
        if let Some(request) = self.next() {
            self.tally.take(&request, merits);
        }
    }

    fn best(&self) -> usize {
        self.tally.best()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyone_gets_the_same_runs_and_the_best_mean_is_chosen() {
        let mut equal = Equal::new(3, 2500);
        let mut told = 0;
        while let Some(request) = equal.next() {
            assert_eq!(request.first_run, told);
            told += request.runs as u64;
            let row = |configuration: &usize| vec![[1.0, 3.0, 2.0][*configuration]; request.runs];
            equal.tell(
                &request
                    .configurations
                    .iter()
                    .flat_map(row)
                    .collect::<Vec<_>>(),
            );
        }
        assert_eq!(equal.runs(), [2500; 3]);
        assert_eq!(equal.best(), 1);
    }
}
