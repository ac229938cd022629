//! When a sensor measures, or a brain steps.

/// Rounding of a rate times a step must not skip a measurement.
const HAIR: f64 = 1e-9;

/// A schedule in steps: the n-th beat is in the first step at or after its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Schedule {
    /// At most 1.
    beats_per_step: f64,
}

impl Schedule {
    /// `rate_hz` beats per second, at most one per step; without a rate, one per step.
    pub(crate) fn new(rate_hz: Option<f64>, step_s: f64) -> Self {
        let beats_per_step = rate_hz.map_or(1.0, |rate_hz| (rate_hz * step_s).min(1.0));
        Self { beats_per_step }
    }

    /// The number of the beat in this step, from 0.
    #[inline]
    pub(crate) fn beat(self, tick: u64) -> Option<u64> {
        if self.is_each_step() {
            return Some(tick);
        }
        let now = self.beats_until(tick);
        let is_beat = tick == 0 || self.beats_until(tick - 1) < now;
        is_beat.then_some(now)
    }

    pub(crate) fn is_each_step(self) -> bool {
        self.beats_per_step >= 1.0
    }

    pub(crate) fn period_s(self, step_s: f64) -> f64 {
        step_s / self.beats_per_step
    }

    /// Maximum number of beats in a number of steps.
    pub(crate) fn beats_in(self, steps: u64) -> usize {
        usize::try_from(self.beats_until(steps)).unwrap_or(usize::MAX - 2) + 1
    }

    /// Beats after the one in step 0, up to this step.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "steps are at most 1e8"
    )]
    fn beats_until(self, tick: u64) -> u64 {
        (tick as f64 * self.beats_per_step + HAIR) as u64
    }
}

/// Number of steps of a duration, rounded up.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times and steps have limits in scenarios; a cast saturates"
)]
pub(crate) fn steps_of(time_s: f64, step_s: f64) -> u64 {
    (time_s / step_s - HAIR).ceil().max(0.0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beat_is_on_the_first_step_at_or_after_its_time() {
        let beats = |rate_hz, steps| {
            let schedule = Schedule::new(rate_hz, 0.1);
            (0..steps)
                .filter_map(|tick| schedule.beat(tick).map(|beat| (tick, beat)))
                .collect::<Vec<_>>()
        };
        assert_eq!(beats(Some(4.0), 9), [(0, 0), (3, 1), (5, 2), (8, 3)]);
        assert_eq!(beats(Some(5.0), 5), [(0, 0), (2, 1), (4, 2)]);
        assert_eq!(beats(None, 3), [(0, 0), (1, 1), (2, 2)]);
        assert_eq!(beats(Some(99.0), 3), [(0, 0), (1, 1), (2, 2)]);
    }

    #[test]
    fn steps_of_a_time_are_rounded_up_but_not_for_rounding() {
        assert_eq!(
            [0.0, 0.05, 0.1, 0.3, 0.31].map(|time| steps_of(time, 0.1)),
            [0, 1, 1, 3, 4]
        );
    }
}
