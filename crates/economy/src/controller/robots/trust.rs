//! Trust in robots, earned by past awards.

use base::hashed::Hashed;

/// Weight of the initial trust, in awards, and its value.
const PRIOR_WEIGHT: f64 = 4.0;
const INITIAL: f64 = 0.9;

/// The share of awards that a robot has served: the mean of a beta distribution,
///
/// ```text
/// trust = (4 x 0.9 + served) / (4 + served + failed)
/// ```
///
/// (Jøsang and Ismail, *The beta reputation system*, 2002).
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(crate) struct Trust {
    served: u32,
    failed: u32,
}

impl Trust {
    pub(crate) fn value(self) -> f64 {
        let [served, failed] = [self.served, self.failed].map(f64::from);
        (PRIOR_WEIGHT * INITIAL + served) / (PRIOR_WEIGHT + served + failed)
    }

    pub(crate) fn learn(&mut self, is_served: bool) {
        let count = if is_served {
            &mut self.served
        } else {
            &mut self.failed
        };
        *count = count.saturating_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trust_rises_with_served_awards_and_falls_with_failed_ones() {
        let mut trust = Trust::default();
        assert!((trust.value() - 0.9).abs() < 1e-12);
        (0..4).for_each(|_| trust.learn(false));
        assert!((trust.value() - 0.45).abs() < 1e-12);
        (0..8).for_each(|_| trust.learn(true));
        assert!(trust.value() > 0.7);
    }
}
