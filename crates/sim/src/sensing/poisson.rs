//! How often something rare happens.

/// Counts above this are cut; means that scenarios allow are far below.
const MOST: u32 = 10_000;

/// A Poisson distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Poisson {
    mean: f64,
    /// Probability of none.
    none: f64,
}

impl Poisson {
    /// With a mean of at most some hundreds: below e^-700 a probability is 0.
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
