//! Gains of the two tracks of a differential drive.

use brain::Motion;

/// Factors on the speeds of the tracks. Their mean is the gain of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gains {
    gain: f64,
    /// Half the difference of the factors of the right and the left track, where their mean is 1.
    skew: f64,
    /// Half the distance between the tracks; not 0 if there is a skew.
    half_track_m: f64,
}

impl Gains {
    /// With a ratio of the factor of the left track to that of the right one.
    pub(crate) fn new(gain: f64, left_right: f64, track_width_m: f64) -> Self {
        Self {
            gain,
            skew: (1.0 - left_right) / (1.0 + left_right),
            half_track_m: track_width_m / 2.0,
        }
    }

    /// The motion that results if both tracks are driven for this one.
    pub(crate) fn applied(&self, motion: Motion) -> Motion {
        if self.skew == 0.0 {
            return Motion {
                speed_m_s: self.gain * motion.speed_m_s,
                turn_rate_rad_s: self.gain * motion.turn_rate_rad_s,
            };
        }
        let turn_m_s = motion.turn_rate_rad_s * self.half_track_m;
        Motion {
            speed_m_s: self.gain * (motion.speed_m_s + self.skew * turn_m_s),
            turn_rate_rad_s: self.gain
                * (motion.turn_rate_rad_s + self.skew * motion.speed_m_s / self.half_track_m),
        }
    }

    /// The highest speed and turn rate that result from motions up to this one.
    pub(crate) fn max(&self, motion: Motion) -> Motion {
        let skew = self.skew.abs();
        Self { skew, ..*self }.applied(motion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn motion(speed_m_s: f64, turn_rate_rad_s: f64) -> Motion {
        Motion {
            speed_m_s,
            turn_rate_rad_s,
        }
    }

    proptest! {
        #[test]
        fn each_track_has_its_factor(
            gain in 0.0..2.0, ratio in 0.1..10.0, width in 0.01..5.0, v in -3.0..3.0, w in -3.0..3.0,
        ) {
            let applied = Gains::new(gain, ratio, width).applied(motion(v, w));
            let tracks = |of: Motion| {
                let turn_m_s = of.turn_rate_rad_s * width / 2.0;
                [of.speed_m_s - turn_m_s, of.speed_m_s + turn_m_s]
            };
            let factors = [2.0 * ratio / (1.0 + ratio), 2.0 / (1.0 + ratio)];
            let wanted = tracks(motion(v, w));
            for (track, executed) in tracks(applied).into_iter().enumerate() {
                prop_assert!((executed - gain * factors[track] * wanted[track]).abs() < 1e-9);
            }
        }

        #[test]
        fn no_motion_within_limits_exceeds_the_maximum(
            ratio in 0.1..10.0, width in 0.01..5.0, v in -1.0..1.0, w in -1.0..1.0,
        ) {
            let gains = Gains::new(1.3, ratio, width);
            let (applied, max) = (gains.applied(motion(v, w)), gains.max(motion(1.0, 1.0)));
            prop_assert!(applied.speed_m_s.abs() <= max.speed_m_s + 1e-12);
            prop_assert!(applied.turn_rate_rad_s.abs() <= max.turn_rate_rad_s + 1e-12);
        }
    }
}
