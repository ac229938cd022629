//! Kim and Nelson's fully sequential procedure, often called KN.

use super::tally::as_f64;
use select::{Elimination, Procedure, Request};

/// Kim and Nelson's procedure with c = 1: after a first stage, one run of each survivor per stage; a
/// configuration that is behind another by more than a shrinking allowance is eliminated.
///
/// Guarantee: if merits are normal, and the best mean is at least `delta` above every other, it is
/// chosen with at least the stated confidence. Configurations may share random numbers: the
/// variances are those of paired differences, so sharing saves runs.
///
/// Source: Kim and Nelson, *A fully sequential procedure for indifference-zone selection in
/// simulation*, ACM Transactions on Modeling and Computer Simulation 11 (2001).
#[derive(Debug, Clone)]
pub(crate) struct KimNelson {
    delta: f64,
    /// `eta / delta` times the sum of squares of a pair's differences is its first allowance.
    eta: f64,
    first_runs: usize,
    sums: Vec<f64>,
    runs: Vec<u64>,
    /// Ascending.
    survivors: Vec<usize>,
    /// Of each pair, in units of summed merit, before any run; square, row-major. Empty until the
    /// first stage is over.
    allowances: Vec<f64>,
    eliminations: Vec<Elimination>,
}

impl KimNelson {
    /// For `configurations >= 1`, a `delta > 0` in units of merit, a `confidence` from 0.5 to
    /// below 1, and `first_runs >= 2` runs per configuration in the first stage (ten or more
    /// are recommended).
    ///
    /// Cost: a number for each pair of configurations, and time for each pair of survivors a run.
    #[must_use]
    pub(crate) fn new(
        configurations: usize,
        delta: f64,
        confidence: f64,
        first_runs: usize,
    ) -> Self {
        debug_assert!(configurations >= 1 && delta > 0.0 && first_runs >= 2);
        debug_assert!((0.5..1.0).contains(&confidence));
        let rivals = as_f64(configurations.max(2) as u64 - 1);
        let power = -2.0 / as_f64(first_runs as u64 - 1);
        let log_chance = libm::log(2.0 * (1.0 - confidence) / rivals);
        Self {
            delta,
            eta: libm::expm1(power * log_chance) / 2.0,
            first_runs,
            sums: vec![0.0; configurations],
            runs: vec![0; configurations],
            survivors: (0..configurations).collect(),
            allowances: Vec::new(),
            eliminations: Vec::new(),
        }
    }

    /// Allowances from the rows of the first stage.
    fn set_allowances(&mut self, rows: &[&[f64]]) {
        let allowance = |a: &&[f64], b: &&[f64]| self.eta / self.delta * squares(a, b);
        let row = |a| rows.iter().map(move |b| allowance(a, b));
        self.allowances = rows.iter().flat_map(row).collect();
    }

    /// Eliminates all that are behind one of those that survived the last stage.
    fn screen(&mut self) {
        let eliminated: Vec<(usize, usize)> = self
            .survivors
            .iter()
            .filter_map(|&each| Some((each, self.winner_over(each)?)))
            .collect();
        for (configuration, by) in eliminated {
            self.survivors.retain(|&each| each != configuration);
            self.eliminations.push(Elimination {
                configuration,
                by: Some(by),
                runs: self.runs[configuration],
            });
        }
    }

    /// The first survivor that is ahead of `this` by more than their allowance.
    fn winner_over(&self, this: usize) -> Option<usize> {
        let shrunk_by = self.delta / 2.0 * as_f64(self.runs[this]);
        let row = &self.allowances[this * self.sums.len()..];
        self.survivors.iter().copied().find(|&other| {
            let allowance = (row[other] - shrunk_by).max(0.0);
            let ahead = self.sums[other] - self.sums[this];
            // When the allowance is zero, only the first of equals remains.
            ahead > allowance || (ahead == 0.0 && allowance == 0.0 && other < this)
        })
    }

    fn in_first_stage(&self) -> bool {
        self.allowances.is_empty()
    }
}

/// Sum of squared deviations of the differences of two rows of runs from their mean.
fn squares(a: &[f64], b: &[f64]) -> f64 {
    let differences = || a.iter().zip(b).map(|(a, b)| a - b);
    let mean = differences().sum::<f64>() / as_f64(a.len() as u64);
    differences()
        .map(|each| (each - mean) * (each - mean))
        .sum()
}

impl Procedure for KimNelson {
    fn next(&self) -> Option<Request> {
        (self.survivors.len() > 1).then(|| Request {
            configurations: self.survivors.clone(),
            first_run: self.runs[self.survivors[0]],
            runs: if self.in_first_stage() {
                self.first_runs
            } else {
                1
            },
        })
    }

    fn record(&mut self, merits: &[f64]) {
        let Some(request) = self.next() else { return };
        debug_assert_eq!(merits.len(), request.configurations.len() * request.runs);
        let rows: Vec<&[f64]> = merits.chunks_exact(request.runs).collect();
        for (&configuration, row) in request.configurations.iter().zip(&rows) {
            self.runs[configuration] += row.len() as u64;
            self.sums[configuration] += row.iter().sum::<f64>();
        }
        if self.in_first_stage() {
            self.set_allowances(&rows);
        }
        self.screen();
    }

    /// The survivor with the greatest mean; the first of equals.
    fn selected(&self) -> Option<usize> {
        let ahead = |best: usize, each: usize| {
            if self.sums[each] > self.sums[best] {
                each
            } else {
                best
            }
        };
        let all = self.survivors.iter().copied();
        all.reduce(ahead)
    }

    fn runs(&self) -> Vec<u64> {
        self.runs.clone()
    }

    fn survivors(&self) -> Vec<usize> {
        self.survivors.clone()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        self.eliminations.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decide(mut merit: impl FnMut(usize, u64) -> f64, configurations: usize) -> KimNelson {
        let mut procedure = KimNelson::new(configurations, 0.1, 0.95, 10);
        while let Some(request) = procedure.next() {
            let mut merits = Vec::new();
            for &each in &request.configurations {
                let numbers = request.first_run..request.first_run + request.runs as u64;
                merits.extend(numbers.map(|run| merit(each, run)));
            }
            procedure.record(&merits);
        }
        procedure
    }

    #[test]
    fn merits_without_noise_are_decided_after_the_first_stage() {
        let procedure = decide(|configuration, _| [1.0, 3.0, 2.0][configuration], 3);
        assert_eq!(procedure.selected(), Some(1));
        assert_eq!(procedure.runs(), [10; 3]);
        assert_eq!(procedure.eliminations().len(), 2);
    }

    #[test]
    fn equals_without_noise_end_with_the_first() {
        assert_eq!(decide(|_, _| 1.0, 4).selected(), Some(0));
    }

    #[test]
    fn noise_that_configurations_share_costs_no_runs() {
        let noise = |run: u64| [0.0, 5.0, 1.0, 4.0][usize::try_from(run % 4).unwrap()];
        let procedure = decide(|each, run| [0.2, 0.1][each] + noise(run), 2);
        assert_eq!(
            (procedure.selected(), procedure.runs()),
            (Some(0), vec![10, 10])
        );
    }

    #[test]
    fn one_configuration_needs_no_runs() {
        assert_eq!(decide(|_, _| 1.0, 1).runs(), [0]);
    }
}
