//! What is left in the battery, and how long it lasts.

use super::pose::fresh;
use crate::io::percept::Percept;

/// After less than this no rate is known, in seconds.
const LEAST_S: f64 = 5.0;

/// A battery that has gained more than this share has been charged, or was misread before; gauges waver by
/// less.
const CHARGED: f64 = 0.1;

/// A share of the battery, and when it was read, in seconds since the brain was switched on.
#[derive(Debug, Clone, Copy)]
struct Level {
    share: f64,
    at_s: f64,
}

/// What is left in the battery: the middle one of what was believed and of the last two readings. So one
/// absurd reading changes nothing, and two in a row are believed, whatever they say.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drain {
    /// Since when it is drained.
    first: Option<Level>,
    left: Option<Level>,
    /// The least that was left since.
    least: f64,
    last: Option<Level>,
    /// Age of the last reading.
    age_s: Option<f64>,
    on_s: f64,
}

impl Drain {
    pub(crate) fn take_in(&mut self, percept: &Percept, period_s: f64) {
        self.on_s += period_s;
        let sane = |share: &f64| (0.0..=1.0).contains(share);
        let battery = percept.battery.filter(|battery| sane(&battery.value));
        let Some(battery) = fresh(battery, &mut self.age_s, period_s) else {
            return;
        };
        let read = Level {
            share: battery.value,
            at_s: self.on_s - battery.age_s,
        };
        if let Some(before) = self.last.replace(read) {
            self.believe(before, read);
        }
    }

    /// Takes in two readings in a row.
    fn believe(&mut self, one: Level, other: Level) {
        let (low, high) = if one.share <= other.share {
            (one, other)
        } else {
            (other, one)
        };
        let left = match self.left {
            Some(left) if left.share < low.share => low,
            Some(left) if left.share <= high.share => left,
            _ => high,
        };
        self.left = Some(left);
        self.least = self.least.min(left.share);
        // A battery that has been charged is drained anew.
        let is_charged = |first: Level| left.share > first.share.min(self.least + CHARGED);
        if self.first.is_none_or(is_charged) {
            (self.first, self.least) = (Some(left), left.share);
        }
    }

    /// Share of the battery that is left, if two readings have said so.
    pub(crate) fn left(&self) -> Option<f64> {
        self.left.map(|left| left.share)
    }

    /// So long it lasts at the rate so far, left t / used; infinite if nobody knows.
    pub(crate) fn lasts_s(&self) -> f64 {
        let Some((first, left)) = self.first.zip(self.left) else {
            return f64::INFINITY;
        };
        let (used, in_s) = (first.share - left.share, left.at_s - first.at_s);
        if used > 0.0 && in_s >= LEAST_S {
            (left.share * in_s / used - (self.on_s - left.at_s)).max(0.0)
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

    #[test]
    fn one_absurd_reading_changes_nothing_and_two_do() {
        for absurd in [0.0, 1.0] {
            let mut drain = Drain::default();
            (0..20).for_each(|_| take(&mut drain, 0.5));
            take(&mut drain, absurd);
            assert_eq!(drain.left(), Some(0.5));
            take(&mut drain, 0.5);
            assert_eq!(drain.left(), Some(0.5));
            (0..2).for_each(|_| take(&mut drain, absurd));
            assert_eq!(drain.left(), Some(absurd));
        }
    }

    #[test]
    fn a_reading_that_is_old_or_told_of_again_is_no_second_one() {
        let mut drain = Drain::default();
        (0..20).for_each(|_| take(&mut drain, 0.5));
        for age_s in [0.0, 1.0, 2.0, 100.0, 1e6, f64::NAN, -1.0] {
            let battery = Some(crate::io::percept::Reading { value: 0.0, age_s });
            let percept = Percept {
                battery,
                ..Percept::default()
            };
            drain.take_in(&percept, 1.0);
            assert_eq!(drain.left(), Some(0.5), "{age_s}");
        }
    }

    #[test]
    fn a_battery_that_has_been_charged_is_drained_anew() {
        let mut drain = Drain::default();
        (0..50).for_each(|second| take(&mut drain, 0.5 - 0.01 * f64::from(second)));
        (0..12).for_each(|second| take(&mut drain, 0.9 - 0.02 * f64::from(second)));
        // 0.68 of 0.02 a second.
        assert!((drain.lasts_s() - 34.0).abs() < 1e-6, "{}", drain.lasts_s());
    }
}
