//! Bounds of a quantile that are valid at every moment.
//!
//! The p-quantile q is the smallest number at or below which a share p of all values lies. For the
//! true q, values at or below it have a share of at least p, and values below it a share of at most p.
//! A candidate for which the runs so far refute one of these (see `bounds`) is excluded. Only the test
//! at the true quantile matters, so no correction for the number of candidates is needed. The bounds
//! are values that occurred; beyond the last one, infinity.
//!
//! Source: Howard and Ramdas (2022), Sequential estimation of quantiles with applications to A/B
//! testing and best-arm identification, Bernoulli 28(3), section 3: the same inversion of a bound for
//! the mean of indicators, there with another one.

use crate::bounds::share_exceeds;

/// The lower and the upper bound of the quantile of a share in 0..1, exclusive, of sorted values; each
/// is wrong with a probability of at most `alpha`.
///
/// Values may be infinite. Without values, or where they do not bound it, a bound is infinite.
#[must_use]
pub fn quantile_bounds(sorted: &[f64], share: f64, alpha: f64) -> (f64, f64) {
    let runs = sorted.len() as u64;
    // The smallest number of values at or below a candidate for which a share of at least p is not
    // refuted: refuted is that fewer than 1 - p lie above it.
    let is_too_few = |count: u64| share_exceeds(runs - count, runs, 1.0 - share, alpha);
    let low = first(runs, |count| !is_too_few(count));
    // The smallest number of values below a candidate that refutes a share of at most p.
    let is_too_many = |count: u64| share_exceeds(count, runs, share, alpha);
    let high = first(runs, is_too_many);
    let value = |place: Option<u64>| {
        let place = usize::try_from(place?).ok()?.checked_sub(1)?;
        sorted.get(place).copied()
    };
    (
        value(low).unwrap_or(f64::NEG_INFINITY),
        value(high).unwrap_or(f64::INFINITY),
    )
}

/// The smallest count up to `runs` at which a condition holds that holds from some count on.
fn first(runs: u64, holds: impl Fn(u64) -> bool) -> Option<u64> {
    let (mut low, mut high) = (0, runs + 1);
    while low < high {
        let middle = u64::midpoint(low, high);
        if middle > runs || holds(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    (low <= runs).then_some(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::random::{Entity, Purpose, stream, unit};

    /// Sorted uniform values.
    fn uniform(seed: u64, count: usize) -> Vec<f64> {
        let entity = Entity { kind: 0, index: 0 };
        let mut random = stream(seed, 0, entity, Purpose::Start);
        (0..count).map(|_| unit(&mut random)).collect()
    }

    fn sorted(values: &[f64]) -> Vec<f64> {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    }

    #[test]
    fn bounds_hold_the_quantile_and_become_narrow() {
        let values = uniform(1, 20_000);
        for (share, width) in [(0.5, 0.03), (0.9, 0.02), (0.95, 0.015)] {
            let (low, high) = quantile_bounds(&sorted(&values), share, 0.025);
            assert!(
                low < share && share < high && high - low < width,
                "{share}: {low} {high}"
            );
        }
    }

    #[test]
    fn few_values_do_not_bound_a_high_quantile() {
        let (low, high) = quantile_bounds(&[1.0, 2.0, 3.0], 0.95, 0.025);
        assert!(high.is_infinite() && low <= 1.0, "{low} {high}");
        assert_eq!(
            quantile_bounds(&[], 0.5, 0.025),
            (f64::NEG_INFINITY, f64::INFINITY)
        );
    }

    #[test]
    fn a_quantile_can_be_infinite() {
        // A third of the runs never complete: the 90% quantile is infinite, the median is not.
        let mut values = vec![1.0; 2000];
        values.extend([f64::INFINITY; 1000]);
        assert!(quantile_bounds(&values, 0.9, 0.025).0.is_infinite());
        assert_eq!(quantile_bounds(&values, 0.5, 0.025), (1.0, 1.0));
    }

    #[test]
    fn bounds_hold_at_every_moment() {
        // Of 2,000 sequences looked at after 20 numbers of runs, at most 5% may ever be wrong on one
        // of two sides of 2.5%; 3% to 5% would need 5% + 3 deviations = 6.5%.
        let looks = [10, 20, 40, 80, 160, 320];
        let wrong = (0..2000).filter(|seed| {
            let values = uniform(*seed, 320);
            looks.iter().any(|runs| {
                let (low, high) = quantile_bounds(&sorted(&values[..*runs]), 0.9, 0.025);
                low > 0.9 || high < 0.9
            })
        });
        let wrong = wrong.count();
        assert!(wrong < 130, "{wrong} of 2,000");
    }
}
