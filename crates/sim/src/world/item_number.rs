//! How many items of a kind a run has.

use crate::poisson::Poisson;
use base::random::{Entity, Purpose, stream, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the number of items of a kind in a run follows from `count`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ItemNumber {
    /// Every run has `count` items.
    #[default]
    Fixed,
    /// Each run draws its number from a Poisson distribution with the mean `count`, at most 500; numbers above
    /// `count` + 8 sqrt(`count`) + 8 become that number.
    Poisson,
}

impl ItemNumber {
    /// The largest number of items in a run of a kind with this `count`. A Poisson variable exceeds it with a
    /// probability below 1e-9.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "counts are at most 1e6"
    )]
    pub(crate) fn max(self, count: u32) -> u32 {
        let mean = f64::from(count);
        match self {
            Self::Poisson if count > 0 => (mean + 8.0 * mean.sqrt() + 8.0).floor() as u32,
            _ => count,
        }
    }

    /// The number of items of a kind in a run. It rises with `count`, so that a run with more expected items has
    /// those of a run with fewer.
    pub(crate) fn draw(self, count: u32, (seed, run): (u64, u64), kind: u32) -> u32 {
        let entity = Entity { kind, index: 0 };
        match self {
            Self::Fixed => count,
            Self::Poisson => {
                let share = unit(&mut stream(seed, run, entity, Purpose::ItemNumber));
                Poisson::new(count.into()).draw(share).min(self.max(count))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sample mean and variance of 40,000 draws stay within 4 standard errors: a correct program fails with a
    /// probability below 2e-4 per statistic, and the seed is fixed.
    #[test]
    fn the_numbers_of_runs_have_the_mean_and_the_variance_of_a_poisson_distribution() {
        let runs = 40_000_u32;
        for count in [1, 8, 120] {
            let draw = |run: u32| ItemNumber::Poisson.draw(count, (7, run.into()), 12_345);
            let numbers: Vec<f64> = (0..runs).map(|run| draw(run).into()).collect();
            let (n, mean) = (f64::from(runs), f64::from(count));
            let average = numbers.iter().sum::<f64>() / n;
            let squares = numbers.iter().map(|number| (number - average).powi(2));
            let variance = squares.sum::<f64>() / n;
            assert!(
                (average - mean).abs() < 4.0 * (mean / n).sqrt(),
                "{average}"
            );
            // The fourth central moment of a Poisson variable is mean (1 + 3 mean).
            let error = ((mean + 2.0 * mean * mean) / n).sqrt();
            assert!((variance - mean).abs() < 4.0 * error, "{variance}");
        }
    }

    #[test]
    fn a_run_with_a_higher_mean_has_no_fewer_items_and_none_exceeds_the_maximum() {
        for run in 0..1000 {
            let draw = |count| ItemNumber::Poisson.draw(count, (3, run), 9);
            let numbers = [0, 1, 5, 60, 500].map(draw);
            assert!(numbers.is_sorted(), "{numbers:?}");
            assert_eq!(numbers[0], 0);
            assert!(numbers[4] <= ItemNumber::Poisson.max(500));
        }
    }
}
