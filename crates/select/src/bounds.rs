//! Bounds of the mean of bounded values (a confidence sequence): they are valid at every moment.
//!
//! A candidate for the mean is refuted when gamblers that bet that the mean is higher (for the lower
//! bound) have made 1 / alpha out of 1; the bound is the highest candidate refuted. Since the
//! gamblers' wealth can reach that under a true candidate with a probability of at most alpha at any
//! time (Ville's inequality), the bound holds however the number of values was chosen.
//!
//! Ten gamblers share the first 1 equally. With values scaled to 0..1 and a candidate m, each always
//! stakes the same part of the limit 1 / m: 0.9 of it, a third of that, and so on. With constant bets
//! the order of the values is irrelevant, so equal values are counted, not repeated; and every
//! gambler's wealth falls as m rises, so the bound is found by bisection.
//!
//! Source: Waudby-Smith and Ramdas (2024), Estimating means of bounded random variables by betting,
//! Journal of the Royal Statistical Society B 86, section 4.

use crate::problem::Bounds;

const GAMBLERS: i32 = 10;
const BOLDEST: f64 = 0.9;
const STEP: f64 = 3.0;

/// Maximum number of distinct values; if there are more, neighbours are merged into the one among
/// them that makes the bound wider.
const MAX_DISTINCT: usize = 8192;

/// Halvings of the interval in which the bound lies.
const HALVINGS: u32 = 30;

/// Factors that are multiplied before a logarithm is taken: 0.1^16 and 10^16 are far from overflow.
const PRODUCT: u64 = 16;

/// The lower and the upper bound of the mean of values that lie within `bounds`; each is wrong with
/// a probability of at most `alpha`.
///
/// Without values, or if `bounds` have no width, they are `bounds`.
#[must_use]
pub fn mean_bounds(values: &[f64], bounds: Bounds, alpha: f64) -> (f64, f64) {
    let width = bounds.max - bounds.min;
    if values.is_empty() || width <= 0.0 {
        return (bounds.min, bounds.max);
    }
    let up = |value: &f64| ((value - bounds.min) / width).clamp(0.0, 1.0);
    let down = |value: &f64| ((bounds.max - value) / width).clamp(0.0, 1.0);
    let low = Counted::new(values.iter().map(up)).lower_bound(alpha);
    let high = Counted::new(values.iter().map(down)).lower_bound(alpha);
    (
        (bounds.min + low * width).min(bounds.max),
        (bounds.max - high * width).max(bounds.min),
    )
}

/// Whether the mean of values that lie within `bounds` is above `candidate`; `true` is wrong with a
/// probability of at most `alpha`.
#[must_use]
pub fn mean_exceeds(values: &[f64], bounds: Bounds, candidate: f64, alpha: f64) -> bool {
    let width = bounds.max - bounds.min;
    if candidate < bounds.min {
        return true;
    }
    if values.is_empty() || width <= 0.0 || candidate >= bounds.max {
        return false;
    }
    let up = |value: &f64| ((value - bounds.min) / width).clamp(0.0, 1.0);
    let counted = Counted::new(values.iter().map(up));
    counted.refutes((candidate - bounds.min) / width, alpha)
}

/// Whether a share of which `hits` of `runs` were observed is above `candidate`, in 0..1; `true` is wrong
/// with a probability of at most `alpha`.
pub(crate) fn share_exceeds(hits: u64, runs: u64, candidate: f64, alpha: f64) -> bool {
    let counted = Counted(vec![(0.0, runs - hits), (1.0, hits)]);
    runs > 0 && counted.refutes(candidate, alpha)
}

/// Values in 0..=1, each with how often it occurs.
struct Counted(Vec<(f64, u64)>);

impl Counted {
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_unstable_by(f64::total_cmp);
        let mut counted: Vec<(f64, u64)> = Vec::new();
        for value in values {
            match counted.last_mut() {
                Some((last, count)) if *last >= value => *count += 1,
                _ => counted.push((value, 1)),
            }
        }
        // Each group counts as its lowest value, so the wealth is never too high.
        let group = counted.len().div_ceil(MAX_DISTINCT).max(1);
        let merged = counted.chunks(group).map(|group| {
            let count = group.iter().map(|(_, count)| count).sum();
            (group[0].0, count)
        });
        Self(merged.collect())
    }

    /// The highest candidate that is refuted, or 0.
    fn lower_bound(&self, alpha: f64) -> f64 {
        let (mut refuted, mut open) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let candidate = f64::midpoint(refuted, open);
            if self.refutes(candidate, alpha) {
                refuted = candidate;
            } else {
                open = candidate;
            }
        }
        refuted
    }

    /// Whether the gamblers made 1 / alpha betting that the mean is above `candidate`, in 0..1.
    fn refutes(&self, candidate: f64, alpha: f64) -> bool {
        if candidate <= 0.0 {
            // The only way for a mean to be 0 is that all values are.
            return self.0.iter().any(|(value, _)| *value > 0.0);
        }
        let goal = libm::log(f64::from(GAMBLERS) / alpha);
        let mut part = BOLDEST;
        let mut wealth = 0.0;
        for _ in 0..GAMBLERS {
            let log = self.log_wealth(candidate, part);
            if log >= goal {
                return true;
            }
            wealth += libm::exp(log - goal);
            part /= STEP;
        }
        wealth >= 1.0
    }

    /// Logarithm of the wealth of a gambler that starts with 1 and always stakes `part` of the limit.
    #[expect(clippy::cast_precision_loss, reason = "values are far fewer than 2^53")]
    fn log_wealth(&self, candidate: f64, part: f64) -> f64 {
        let (mut log, mut product, mut factors) = (0.0, 1.0, 0);
        for (value, count) in &self.0 {
            let factor = 1.0 - part + part * value / candidate;
            if *count > 1 || factor > 10.0 {
                log += *count as f64 * libm::log(factor);
                continue;
            }
            product *= factor;
            factors += 1;
            if factors == PRODUCT {
                log += libm::log(product);
                (product, factors) = (1.0, 0);
            }
        }
        log + libm::log(product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const UNIT: Bounds = Bounds { min: 0.0, max: 1.0 };

    #[test]
    fn clean_runs_bound_a_rare_failure() {
        // 299 clean runs show p <= 1% at 95% when their number is fixed beforehand (1 - 0.05^(1/299));
        // a bound that holds at every moment requires more, but not for three times as many.
        let (low, high) = mean_bounds(&[0.0; 900], UNIT, 0.05);
        assert!(low <= 0.0);
        assert!((0.003..0.01).contains(&high), "{high}");
    }

    #[test]
    fn without_values_or_width_nothing_is_claimed() {
        assert_eq!(mean_bounds(&[], UNIT, 0.05), (0.0, 1.0));
        let point = Bounds { min: 2.0, max: 2.0 };
        assert_eq!(mean_bounds(&[2.0; 5], point, 0.05), (2.0, 2.0));
        assert!(!mean_exceeds(&[2.0; 5], point, 2.0, 0.05));
        assert!(mean_exceeds(&[], point, 1.0, 0.05));
    }

    #[test]
    fn merging_neighbours_only_widens() {
        let values: Vec<f64> = (0..40_000)
            .map(|i| f64::from(i * 7919 % 40_000) / 4e4)
            .collect();
        let few = &values[..MAX_DISTINCT];
        let (low, high) = mean_bounds(&values, UNIT, 0.025);
        assert!(low < 0.5 && 0.5 < high && high - low < 0.02, "{low} {high}");
        let (low_few, high_few) = mean_bounds(few, UNIT, 0.025);
        assert!(high - low < high_few - low_few);
    }

    proptest! {
        #[test]
        fn bounds_hold_the_mean_and_agree_with_the_test(
            values in prop::collection::vec(0.0..=1.0, 1..200),
            scale in 0.1..100.0f64, shift in -50.0..50.0f64,
        ) {
            let bounds = Bounds { min: shift, max: shift + scale };
            let values: Vec<f64> = values.iter().map(|value: &f64| shift + scale * value).collect();
            let mean = values.iter().sum::<f64>() / f64::from(u32::try_from(values.len()).unwrap());
            let (low, high) = mean_bounds(&values, bounds, 0.05);
            prop_assert!(bounds.min <= low && low <= mean + 1e-9 && mean - 1e-9 <= high && high <= bounds.max);
            prop_assert!(mean_exceeds(&values, bounds, low - 1e-6 * scale, 0.05));
            prop_assert!(!mean_exceeds(&values, bounds, low + 1e-6 * scale, 0.05));
        }
    }
}
