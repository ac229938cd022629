//! Poisson distribution: how often something rare happens.

/// Maximum mean that scenarios may set: below e^-700 a probability would be 0.
pub(crate) const MAX_MEAN: f64 = 500.0;

/// Larger counts are cut off; means that scenarios allow are far below.
const MOST: u32 = 10_000;

/// A Poisson distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Poisson {
    mean: f64,
    /// Probability of none.
    none: f64,
}

impl Poisson {
    /// With a mean of at most [`MAX_MEAN`].
    pub(crate) fn new(mean: f64) -> Self {
        Self {
            mean,
            none: libm::exp(-mean),
        }
    }

    /// The count whose cumulative probability first exceeds `share`.
    #[inline]
    pub(crate) fn draw(&self, share: f64) -> u32 {
        let (mut probability, mut below) = (self.none, self.none);
        let mut count = 0;
        while share >= below && count < MOST {
            count += 1;
            probability *= self.mean / f64::from(count);
            below += probability;
            if probability < 1e-18 && f64::from(count) > self.mean {
                break;
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A draw inverts the distribution: the fraction of counts above `count` is that of the closed
    /// form, up to the resolution of the shares.
    #[test]
    fn draws_have_the_distribution_of_the_closed_form() {
        for mean in [1e-3, 0.3, 4.0, 50.0, 500.0_f64] {
            let poisson = Poisson::new(mean);
            let steps = 20_000;
            let draws =
                (0..steps).map(|step| poisson.draw((f64::from(step) + 0.5) / f64::from(steps)));
            let draws: Vec<f64> = draws.map(f64::from).collect();
            let count = f64::from(steps);
            let average = draws.iter().sum::<f64>() / count;
            let variance = draws
                .iter()
                .map(|draw| (draw - average).powi(2))
                .sum::<f64>()
                / count;
            let fine = 1e-3 * mean.max(mean.sqrt()) + 2.0 / count;
            assert!((average - mean).abs() < fine, "{mean}: {average}");
            assert!(
                (variance / mean - 1.0).abs() < 0.02 || mean < 0.1,
                "{mean}: {variance}"
            );
            let none = draws.iter().filter(|draw| **draw == 0.0).count() as f64 / count;
            assert!(
                (none - libm::exp(-mean)).abs() <= 1.0 / count,
                "{mean}: {none}"
            );
        }
    }

    #[test]
    fn counts_grow_with_the_share_and_end() {
        for mean in [0.0, 1e-9, 2.0, 600.0] {
            let poisson = Poisson::new(mean);
            let shares = [
                0.5 / 4_294_967_296.0,
                0.1,
                0.5,
                0.9,
                1.0 - 0.5 / 4_294_967_296.0,
            ];
            let draws = shares.map(|share| poisson.draw(share));
            assert!(draws.windows(2).all(|pair| pair[0] <= pair[1]), "{draws:?}");
            assert!(
                f64::from(draws[4]) < mean + 20.0 + 10.0 * mean.sqrt(),
                "{mean}: {draws:?}"
            );
        }
    }
}
