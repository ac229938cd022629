//! When a sensor measures, or a brain steps.

/// Rounding of a rate times a step must not skip a measurement.
const HAIR: f64 = 1e-9;

/// A periodic schedule in steps: event `n` is in the first step at or after its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Schedule {
    /// At most 1.
    events_per_step: f64,
}

impl Schedule {
    /// `rate_hz` events per second, at most one per step; without a rate, one per step.
    pub(crate) fn new(rate_hz: Option<f64>, step_s: f64) -> Self {
        let events_per_step = rate_hz.map_or(1.0, |rate_hz| (rate_hz * step_s).min(1.0));
        Self { events_per_step }
    }

    /// The number of the event that is due in this step, from 0.
    #[inline]
    pub(crate) fn due(self, tick: u64) -> Option<u64> {
        if self.is_every_step() {
            return Some(tick);
        }
        let now = self.events_until(tick);
        let is_due = tick == 0 || self.events_until(tick - 1) < now;
        is_due.then_some(now)
    }

    pub(crate) fn is_every_step(self) -> bool {
        self.events_per_step >= 1.0
    }

    pub(crate) fn period_s(self, step_s: f64) -> f64 {
        step_s / self.events_per_step
    }

    /// Maximum number of events in a number of steps.
    pub(crate) fn max_events_in(self, steps: u64) -> usize {
        usize::try_from(self.events_until(steps)).unwrap_or(usize::MAX - 2) + 1
    }

    /// Events after the one in step 0, up to this step.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "steps are at most 1e8"
    )]
    fn events_until(self, tick: u64) -> u64 {
        (tick as f64 * self.events_per_step + HAIR) as u64
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
    fn an_event_is_due_in_the_first_step_at_or_after_its_time() {
        let events = |rate_hz, steps| {
            let schedule = Schedule::new(rate_hz, 0.1);
            (0..steps)
                .filter_map(|tick| schedule.due(tick).map(|event| (tick, event)))
                .collect::<Vec<_>>()
        };
        assert_eq!(events(Some(4.0), 9), [(0, 0), (3, 1), (5, 2), (8, 3)]);
        assert_eq!(events(Some(5.0), 5), [(0, 0), (2, 1), (4, 2)]);
        assert_eq!(events(None, 3), [(0, 0), (1, 1), (2, 2)]);
        assert_eq!(events(Some(99.0), 3), [(0, 0), (1, 1), (2, 2)]);
    }

    #[test]
    fn steps_of_a_time_are_rounded_up_but_not_for_rounding() {
        assert_eq!(
            [0.0, 0.05, 0.1, 0.3, 0.31].map(|time| steps_of(time, 0.1)),
            [0, 1, 1, 3, 4]
        );
    }
}
