//! Timers of behaviours. They follow the times of percepts, so that they take the same time at any
//! rate of percepts.

use crate::situation::Situation;

/// The time since an event, counted from the step after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stopwatch {
    /// In seconds; negative until that step.
    since_s: f32,
}

impl Stopwatch {
    /// A stopwatch for an event in this step.
    pub(crate) const START: Self = Self { since_s: -1.0 };

    /// The time in seconds. To be called once in every step.
    #[inline]
    pub(crate) fn read_s(&mut self, situation: &Situation) -> f64 {
        self.since_s = if self.since_s < 0.0 {
            0.0
        } else {
            self.since_s + situation.step_s()
        };
        self.since_s.into()
    }
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self::START
    }
}

/// The rest of a duration, which begins in the step after the countdown was set.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Countdown {
    /// In seconds; negative until that step.
    left_s: f32,
}

impl Countdown {
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "hours at most")]
    pub(crate) fn new(duration_s: f64) -> Self {
        Self {
            left_s: -duration_s as f32,
        }
    }

    /// Counts down to this step. To be called once in every step.
    #[inline]
    pub(crate) fn advance(&mut self, situation: &Situation) {
        self.left_s = if self.left_s < 0.0 {
            -self.left_s
        } else {
            (self.left_s - situation.step_s()).max(0.0)
        };
    }

    /// Whether time is left for more than half of this step, so that rounding does not add a step.
    #[inline]
    pub(crate) fn is_running(self, situation: &Situation) -> bool {
        self.left_s > situation.half_step_s()
    }

    /// The time that is left at the end of this step, if it lasts a period, in seconds.
    #[expect(clippy::cast_possible_truncation, reason = "seconds")]
    pub(crate) fn left_s(self, period_s: f64) -> f64 {
        f64::from(if self.left_s < 0.0 {
            -self.left_s
        } else {
            (self.left_s - period_s as f32).max(0.0)
        })
    }
}
