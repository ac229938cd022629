//! The validation gate of readings: outliers are rejected unless several in a row agree.

use base::hashed::Hashed;

/// Half width of the gate, in standard deviations of the difference (Bar-Shalom and Fortmann,
/// *Tracking and data association*, 1988). Of unbiased readings it rejects one in 1.7 million in
/// one dimension, 2 (1 - Phi(5)), and one in 270,000 in two, exp(-5^2 / 2).
const GATE: f64 = 5.0;

/// Number of consecutive outliers in agreement after which the estimate is reset.
const RESET_AFTER: u8 = 3;

/// The last rejected reading, and the number of consecutive rejected readings in agreement, itself
/// included.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(crate) struct ValidationGate<T> {
    last: T,
    count: u8,
}

/// The difference between a reading and the estimate, and how much of it is expected.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Innovation {
    pub(crate) distance: f64,
    /// Of the estimate and of the sensor, along each axis.
    pub(crate) variances: [f64; 2],
}

impl Innovation {
    /// Whether the reading is outside the gate; that of an exact sensor never is.
    pub(super) fn is_outside(&self) -> bool {
        let [own, sensor] = self.variances;
        sensor > 0.0 && self.distance * self.distance > GATE * GATE * (own + sensor)
    }
}

/// What to do with a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Correct the estimate with it.
    Accept,
    /// Ignore it.
    Reject,
    /// Reset the estimate to it: the estimate was wrong.
    Reset,
}

impl<T: Copy> ValidationGate<T> {
    /// Decides what to do with a reading; `distance` is its distance from another reading.
    ///
    /// Two readings agree if their distance is less than half the distance of the later one from
    /// the estimate. This also recovers a body with slipping wheels, whose readings differ by more
    /// than their noise.
    #[inline]
    pub(crate) fn check(
        &mut self,
        reading: T,
        innovation: &Innovation,
        distance: impl Fn(&T) -> f64,
    ) -> Verdict {
        if !innovation.is_outside() {
            self.count = 0;
            return Verdict::Accept;
        }
        let agrees = self.count > 0 && distance(&self.last) < innovation.distance / 2.0;
        self.count = if agrees { self.count + 1 } else { 1 };
        self.last = reading;
        if self.count < RESET_AFTER {
            return Verdict::Reject;
        }
        self.count = 0;
        Verdict::Reset
    }

    /// Moves the last rejected reading along with the body.
    #[inline]
    pub(crate) fn predict(&mut self, motion: impl Fn(T) -> T) {
        if self.count > 0 {
            self.last = motion(self.last);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The verdicts on readings in one dimension, for an estimate of 0 and a total standard
    /// deviation of 1.
    fn verdicts(readings: &[f64]) -> Vec<Verdict> {
        let mut gate = ValidationGate::default();
        let each = readings.iter().map(|reading: &f64| {
            let innovation = Innovation {
                distance: reading.abs(),
                variances: [0.36, 0.64],
            };
            gate.check(*reading, &innovation, |last: &f64| (last - reading).abs())
        });
        each.collect()
    }

    #[test]
    fn readings_beyond_five_deviations_are_rejected() {
        assert_eq!(verdicts(&[4.99, -5.01]), [Verdict::Accept, Verdict::Reject]);
    }

    #[test]
    fn three_consecutive_outliers_in_agreement_reset_the_estimate() {
        use Verdict::{Accept, Reject, Reset};
        assert_eq!(verdicts(&[9.0, 9.1, 8.9]), [Reject, Reject, Reset]);
        assert_eq!(
            verdicts(&[9.0, 9.1, 0.0, 8.9]),
            [Reject, Reject, Accept, Reject]
        );
        assert_eq!(verdicts(&[9.0, -9.0, 9.0, -9.0]), [Reject; 4]);
        assert_eq!(verdicts(&[9.0, 900.0, 9.0, 9.1]), [Reject; 4]);
    }

    #[test]
    fn diverging_outliers_reset_the_estimate() {
        let verdicts = verdicts(&[10.0, 19.0, 28.0]);
        assert_eq!(verdicts, [Verdict::Reject, Verdict::Reject, Verdict::Reset]);
    }

    #[test]
    fn readings_of_an_exact_sensor_are_never_rejected() {
        let innovation = Innovation {
            distance: 1e6,
            variances: [1.0, 0.0],
        };
        assert!(!innovation.is_outside());
    }
}
