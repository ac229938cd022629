//! The clocks of robots and controllers.

use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::{Noise, share};

/// How far the clocks of robots and controllers may be from the true time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct AgentClocks {
    pub(crate) max_offset_s: f64,
    pub(crate) max_drift: f64,
}

impl AgentClocks {
    /// The time on the clock of a robot or controller with these random numbers.
    #[inline]
    pub(crate) fn time_s(self, noise: Noise, true_s: f64) -> f64 {
        if self == Self::default() {
            return true_s;
        }
        let words = noise.words(NoisePurpose::Clock as u32, 0, 0);
        let drift = self.max_drift * (2.0 * share(words[0]) - 1.0);
        true_s * (1.0 + drift) + self.max_offset_s * share(words[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::random::Entity;

    #[test]
    fn a_clock_is_ahead_by_its_offset_and_runs_at_its_own_rate() {
        let clocks = AgentClocks {
            max_offset_s: 5.0,
            max_drift: 0.01,
        };
        let of = |index| Noise::of(1, 0, Entity { kind: 0, index });
        let mut rates = Vec::new();
        for noise in (0..100).map(of) {
            let [start_s, later_s] = [0.0, 100.0].map(|time_s| clocks.time_s(noise, time_s));
            assert!((0.0..=5.0).contains(&start_s));
            rates.push((later_s - start_s) / 100.0);
            assert_eq!(AgentClocks::default().time_s(noise, 12.3), 12.3);
        }
        let [low, high] = [f64::min, f64::max].map(|most| rates.iter().copied().reduce(most));
        assert!((0.99..0.995).contains(&low.unwrap_or(0.0)), "{low:?}");
        assert!((1.005..1.01).contains(&high.unwrap_or(0.0)), "{high:?}");
    }
}
