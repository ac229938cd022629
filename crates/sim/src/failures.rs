//! Failures at random times.

use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::{Noise, share};

/// Whether a robot or controller fails in a step: the time until then has an exponential distribution.
pub(crate) fn fails(noise: Noise, mean_s: f64, (tick, step_s): (u64, f64)) -> bool {
    let probability = -libm::expm1(-step_s / mean_s);
    share(noise.words(NoisePurpose::Failure as u32, tick, 0)[0]) < probability
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::random::Entity;

    #[test]
    fn the_mean_time_until_a_failure_is_as_given() {
        let fails_after = |index: u32| {
            let noise = Noise::of(1, 0, Entity { kind: 0, index });
            let mut ticks = 0..;
            ticks.find(|tick| fails(noise, 20.0, (*tick, 0.5)))
        };
        let total: u64 = (0..4000).filter_map(fails_after).sum();
        // The standard error of the mean is 0.32 s.
        let mean_s = total as f64 * 0.5 / 4000.0;
        assert!((mean_s - 20.0).abs() < 1.0, "{mean_s}");
    }
}
