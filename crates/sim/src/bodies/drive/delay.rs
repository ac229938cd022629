//! Delay of setpoints: each has an effect a fixed time after the brain has set it.

use base::hash::Hash;
use base::hashed::Hashed;
use brain::Motion;
use std::collections::VecDeque;

/// A delay, as steps and the fraction of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Delay {
    steps: usize,
    /// The fraction of a step in which the earlier of two setpoints is in force.
    share: f64,
}

impl Delay {
    pub(crate) fn new(delay_s: f64, step_s: f64) -> Self {
        let parts = delay_s / step_s;
        // Delays that are multiples of the step but for rounding.
        let nearest = parts.round();
        let is_multiple = (parts - nearest).abs() < 1e-9;
        let parts = if is_multiple { nearest } else { parts };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to 1e7"
        )]
        let whole = parts as usize;
        Self {
            steps: whole,
            share: parts.fract(),
        }
    }

    /// Number of setpoints that a queue for this delay holds.
    pub(crate) fn setpoints(&self) -> usize {
        self.steps + 2
    }

    /// The mean over a step in which one setpoint is in force after another.
    pub(crate) fn mean(&self, [early, late]: [Motion; 2]) -> Motion {
        let mean = |early: f64, late: f64| late + self.share * (early - late);
        Motion {
            speed_m_s: mean(early.speed_m_s, late.speed_m_s),
            turn_rate_rad_s: mean(early.turn_rate_rad_s, late.turn_rate_rad_s),
        }
    }
}

/// The setpoints of the last steps, the newest last. It never grows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SetpointQueue(VecDeque<Motion>);

impl SetpointQueue {
    /// With one setpoint in all steps so far.
    pub(crate) fn new(delay: Delay, setpoint: Motion) -> Self {
        Self(vec![setpoint; delay.setpoints()].into())
    }

    /// Adds the setpoint of a step.
    #[inline]
    pub(crate) fn push(&mut self, setpoint: Motion) {
        self.0.rotate_left(1);
        if let Some(newest) = self.0.back_mut() {
            *newest = setpoint;
        }
    }

    /// The setpoints in force in a step, one after the other.
    #[inline]
    pub(crate) fn in_force(&self) -> [Motion; 2] {
        [0, 1].map(|place| self.0.get(place).copied().unwrap_or_default())
    }

    /// Takes over the newest setpoints of another queue; before those, its oldest one was in force.
    pub(crate) fn take_over(&mut self, before: &Self) {
        let oldest = before.in_force()[0];
        let older = std::iter::repeat(oldest);
        let newest_first = before.0.iter().rev().copied().chain(older);
        for (setpoint, was) in self.0.iter_mut().rev().zip(newest_first) {
            *setpoint = was;
        }
    }

    pub(crate) fn add_to(&self, hash: &mut Hash) {
        for setpoint in &self.0 {
            [setpoint.speed_m_s, setpoint.turn_rate_rad_s].add_to(hash);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(speed_m_s: f64) -> Motion {
        Motion {
            speed_m_s,
            turn_rate_rad_s: -speed_m_s,
        }
    }

    /// The means of steps in which the setpoints 1, 2, 3... are set.
    fn means(delay_s: f64) -> Vec<f64> {
        let delay = Delay::new(delay_s, 0.1);
        let mut queue = SetpointQueue::new(delay, at(0.0));
        let steps = 1..=5;
        let means = steps.map(|step| {
            queue.push(at(f64::from(step)));
            delay.mean(queue.in_force())
        });
        let means = means.inspect(|mean| assert_eq!(mean.speed_m_s, -mean.turn_rate_rad_s));
        means.map(|mean| mean.speed_m_s).collect()
    }

    #[test]
    fn a_setpoint_has_its_effect_after_the_delay() {
        assert_eq!(means(0.0), [1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(means(0.1), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(means(0.3), [0.0, 0.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn within_a_step_the_mean_of_the_setpoints_in_force_counts() {
        let expected = [0.0, 0.75, 1.75, 2.75, 3.75];
        for (mean, expected) in means(0.125).into_iter().zip(expected) {
            assert!((mean - expected).abs() < 1e-12, "{mean}");
        }
    }

    #[test]
    fn a_queue_for_another_delay_keeps_the_newest_setpoints() {
        let filled = |delay_s: f64| {
            let mut queue = SetpointQueue::new(Delay::new(delay_s, 0.1), at(0.0));
            (1..=9).for_each(|step| queue.push(at(f64::from(step))));
            queue
        };
        let mut shorter = SetpointQueue::new(Delay::new(0.1, 0.1), at(0.0));
        shorter.take_over(&filled(0.3));
        assert_eq!(shorter.in_force(), [at(7.0), at(8.0)]);
        let mut longer = SetpointQueue::new(Delay::new(0.4, 0.1), at(0.0));
        longer.take_over(&filled(0.1));
        assert_eq!(longer.in_force(), [at(7.0), at(7.0)]);
        longer.push(at(10.0));
        longer.push(at(11.0));
        assert_eq!(longer.in_force(), [at(7.0), at(7.0)]);
        longer.push(at(12.0));
        longer.push(at(13.0));
        assert_eq!(longer.in_force(), [at(8.0), at(9.0)]);
    }
}
