//! How long the battery lasts.

use crate::percept::Percept;

/// After less than this no rate is known, in seconds.
const LEAST_S: f64 = 5.0;

/// The battery's share when it was first read, and for how long it has been drained since.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drain {
    first: Option<f64>,
    left: f64,
    since_s: f64,
}

impl Drain {
    pub(crate) fn take_in(&mut self, percept: &Percept, period_s: f64) {
        let read = percept.battery.map(|battery| battery.value);
        let read = read.filter(|share| (0.0..=1.0).contains(share));
        self.since_s += period_s;
        if let Some(left) = read {
            self.left = left;
            // A battery that has been charged is drained anew.
            if self.first.is_none_or(|first| left > first) {
                (self.first, self.since_s) = (Some(left), 0.0);
            }
        }
    }

    /// So long it lasts at the rate so far; infinite if nobody knows.
    pub(crate) fn lasts_s(&self) -> f64 {
        let Some(first) = self.first.filter(|_| self.since_s >= LEAST_S) else {
            return f64::INFINITY;
        };
        let used = first - self.left;
        if used > 0.0 {
            self.left * self.since_s / used
        } else {
            f64::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::now;

    fn take(drain: &mut Drain, share: f64) {
        let percept = Percept {
            battery: Some(now(share)),
            ..Percept::default()
        };
        drain.take_in(&percept, 1.0);
    }

    #[test]
    fn a_battery_that_lost_a_tenth_in_ten_seconds_lasts_for_ninety_more() {
        let mut drain = Drain::default();
        (0..=10).for_each(|second| take(&mut drain, 1.0 - 0.01 * f64::from(second)));
        assert!((drain.lasts_s() - 90.0).abs() < 1e-6, "{}", drain.lasts_s());
    }

    #[test]
    fn without_readings_or_at_the_beginning_nobody_knows() {
        let mut drain = Drain::default();
        drain.take_in(&Percept::default(), 100.0);
        assert!(drain.lasts_s().is_infinite());
        take(&mut drain, 0.9);
        take(&mut drain, 0.8);
        assert!(drain.lasts_s().is_infinite());
        take(&mut drain, f64::NAN);
    }
}
