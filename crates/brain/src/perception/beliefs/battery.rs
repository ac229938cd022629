//! The battery: its charge and the estimated remaining time.

use super::readings::fresh;
use crate::io::percept::Percept;
use base::hashed::Hashed;

/// Minimum time over which the rate of discharge is estimated.
const MIN_INTERVAL_S: f64 = 5.0;

/// An increase by more than this fraction is taken as charging, not as noise of the gauge.
const MIN_CHARGE_GAIN: f64 = 0.1;

/// A charge, as a fraction of the capacity, and its time in seconds since the brain was started.
#[derive(Debug, Clone, Copy, Hashed)]
struct Level {
    charge: f64,
    at_s: f64,
}

/// The charge of the battery: the median of the previous estimate and the last two readings, so
/// that a single outlier has no effect, and two in a row are accepted.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Battery {
    /// The start of the discharge.
    first: Option<Level>,
    now: Option<Level>,
    /// The minimum charge since then.
    min_charge: f64,
    last: Option<Level>,
    /// Age of the last reading.
    age_s: Option<f64>,
    uptime_s: f64,
}

impl Battery {
    pub(crate) fn update(&mut self, percept: &Percept, elapsed_s: f64) {
        self.uptime_s += elapsed_s;
        let is_valid = |charge: &f64| (0.0..=1.0).contains(charge);
        let battery = percept.battery.filter(|battery| is_valid(&battery.value));
        let Some(battery) = fresh(battery, &mut self.age_s, elapsed_s) else {
            return;
        };
        let read = Level {
            charge: battery.value,
            at_s: self.uptime_s - battery.age_s,
        };
        if let Some(before) = self.last.replace(read) {
            self.correct(before, read);
        }
    }

    /// Updates the estimate with the last two readings.
    fn correct(&mut self, one: Level, other: Level) {
        let (low, high) = if one.charge <= other.charge {
            (one, other)
        } else {
            (other, one)
        };
        let now = match self.now {
            Some(now) if now.charge < low.charge => low,
            Some(now) if now.charge <= high.charge => now,
            _ => high,
        };
        self.now = Some(now);
        self.min_charge = self.min_charge.min(now.charge);
        // The rate of discharge is estimated from the last charging on.
        let is_charged =
            |first: Level| now.charge > first.charge.min(self.min_charge + MIN_CHARGE_GAIN);
        if self.first.is_none_or(is_charged) {
            (self.first, self.min_charge) = (Some(now), now.charge);
        }
    }

    /// The charge, 0 to 1, once there have been two readings.
    pub(crate) fn charge(&self) -> Option<f64> {
        self.now.map(|now| now.charge)
    }

    /// The remaining time at the mean rate so far, charge x time / used; infinite if unknown.
    pub(crate) fn remaining_s(&self) -> f64 {
        let Some((first, now)) = self.first.zip(self.now) else {
            return f64::INFINITY;
        };
        let (used, in_s) = (first.charge - now.charge, now.at_s - first.at_s);
        if used > 0.0 && in_s >= MIN_INTERVAL_S {
            (now.charge * in_s / used - (self.uptime_s - now.at_s)).max(0.0)
        } else {
            f64::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::now;

    fn read(battery: &mut Battery, charge: f64) {
        let percept = Percept {
            battery: Some(now(charge)),
            ..Percept::default()
        };
        battery.update(&percept, 1.0);
    }

    #[test]
    fn a_battery_that_lost_a_tenth_in_ten_seconds_lasts_ninety_more_seconds() {
        let mut battery = Battery::default();
        (0..=10).for_each(|second| read(&mut battery, 1.0 - 0.01 * f64::from(second)));
        assert!(
            (battery.remaining_s() - 90.0).abs() < 1e-6,
            "{}",
            battery.remaining_s()
        );
    }

    #[test]
    fn the_remaining_time_is_unknown_without_enough_readings() {
        let mut battery = Battery::default();
        battery.update(&Percept::default(), 100.0);
        assert!(battery.remaining_s().is_infinite());
        read(&mut battery, 0.9);
        read(&mut battery, 0.8);
        assert!(battery.remaining_s().is_infinite());
        read(&mut battery, f64::NAN);
    }

    #[test]
    fn a_single_outlier_changes_nothing_and_two_in_a_row_do() {
        for outlier in [0.0, 1.0] {
            let mut battery = Battery::default();
            (0..20).for_each(|_| read(&mut battery, 0.5));
            read(&mut battery, outlier);
            assert_eq!(battery.charge(), Some(0.5));
            read(&mut battery, 0.5);
            assert_eq!(battery.charge(), Some(0.5));
            (0..2).for_each(|_| read(&mut battery, outlier));
            assert_eq!(battery.charge(), Some(outlier));
        }
    }

    #[test]
    fn outdated_and_repeated_readings_do_not_count() {
        let mut battery = Battery::default();
        (0..20).for_each(|_| read(&mut battery, 0.5));
        for age_s in [0.0, 1.0, 2.0, 100.0, 1e6, f64::NAN, -1.0] {
            let reading = crate::io::percept::Reading { value: 0.0, age_s };
            let percept = Percept {
                battery: Some(reading),
                ..Percept::default()
            };
            battery.update(&percept, 1.0);
            assert_eq!(battery.charge(), Some(0.5), "{age_s}");
        }
    }

    #[test]
    fn charging_restarts_the_estimate() {
        let mut battery = Battery::default();
        (0..50).for_each(|second| read(&mut battery, 0.5 - 0.01 * f64::from(second)));
        (0..12).for_each(|second| read(&mut battery, 0.9 - 0.02 * f64::from(second)));
        // 0.68 at 0.02 per second.
        assert!(
            (battery.remaining_s() - 34.0).abs() < 1e-6,
            "{}",
            battery.remaining_s()
        );
    }
}
