//! Sines and cosines that return the same bits on every machine.
//!
//! The functions of the platform differ between C libraries, and those of the crate `libm` take four
//! times as long. Here, the angle is reduced to within an eighth of a turn of 0, and the series is
//! summed with additions and multiplications only, without branches, which compilers vectorise.

use std::f64::consts::FRAC_2_PI;

/// Adding and subtracting this number rounds a number below 2^51 to the nearest whole number.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// A quarter of a turn in three parts: multiples of the first two, up to 2^20, are exact.
const QUARTER: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];

/// Coefficients of the sine: 1/3!, 1/5!, ...
const SINE: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];

/// Coefficients of the cosine: 1/2!, 1/4!, ...
const COSINE: [f64; 8] = [
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// Sine and cosine of an angle of at most 10^6, within 4e-16.
///
/// ```
/// let (sine, cosine) = base::trig::sin_cos(std::f64::consts::FRAC_PI_6);
/// assert!((sine - 0.5).abs() < 4e-16 && (cosine - 0.75_f64.sqrt()).abs() < 4e-16);
/// ```
#[must_use]
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "it is vectorised in its callers' loops"
)]
pub fn sin_cos(angle_rad: f64) -> (f64, f64) {
    let shifted = angle_rad * FRAC_2_PI + ROUNDER;
    let quarters = shifted - ROUNDER;
    let rest = angle_rad - quarters * QUARTER[0] - quarters * QUARTER[1] - quarters * QUARTER[2];
    let square = rest * rest;
    let sine = rest + rest * square * series(&SINE, square);
    let cosine = 1.0 + square * series(&COSINE, square);
    // The last bits of `shifted` are those of the number of quarters.
    let quadrant = shifted.to_bits();
    let (one, other) = if quadrant & 1 == 0 {
        (sine, cosine)
    } else {
        (cosine, sine)
    };
    let flip = |is_negative: u64, value: f64| f64::from_bits(value.to_bits() ^ (is_negative << 63));
    (
        flip((quadrant >> 1) & 1, one),
        flip((quadrant >> 1 ^ quadrant) & 1, other),
    )
}

#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "it is vectorised in its callers' loops"
)]
fn series(terms: &[f64; 8], x: f64) -> f64 {
    let last = terms[7];
    terms[..7]
        .iter()
        .rev()
        .fold(last, |sum, term| sum * x + term)
}

/// The same direction, from -pi to pi.
#[must_use]
#[inline]
pub fn wrapped(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle_rad.abs() <= PI {
        return angle_rad;
    }
    let turns = (angle_rad / TAU + ROUNDER) - ROUNDER;
    angle_rad - turns * TAU
}

/// The same direction in degrees, above -180 and at most 180.
#[must_use]
pub fn wrapped_deg(angle_deg: f64) -> f64 {
    if angle_deg > -180.0 && angle_deg <= 180.0 {
        return angle_deg;
    }
    let turned_deg = angle_deg.rem_euclid(360.0);
    if turned_deg > 180.0 {
        turned_deg - 360.0
    } else {
        turned_deg
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sine_and_cosine_are_those_of_the_reference(angle in -1e6_f64..1e6) {
            let (sine, cosine) = sin_cos(angle);
            prop_assert!((sine - libm::sin(angle)).abs() < 4e-16);
            prop_assert!((cosine - libm::cos(angle)).abs() < 4e-16);
        }

        #[test]
        fn a_wrapped_angle_has_the_same_direction(angle in -1e4_f64..1e4) {
            let near = wrapped(angle);
            prop_assert!(near.abs() <= std::f64::consts::PI + 1e-9);
            prop_assert!((libm::sin(near) - libm::sin(angle)).abs() < 1e-11);
            prop_assert!((libm::cos(near) - libm::cos(angle)).abs() < 1e-11);
        }
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "exact by construction")]
    fn whole_turns_are_taken_from_degrees() {
        for (angle, wrapped) in [
            (180.0, 180.0),
            (-180.0, 180.0),
            (-0.1, -0.1),
            (190.0, -170.0),
            (-540.0, 180.0),
            (725.0, 5.0),
        ] {
            assert_eq!(wrapped_deg(angle), wrapped, "{angle}");
        }
    }

    #[test]
    fn whole_quarters_of_a_turn_have_their_signs() {
        for (quarters, sine, cosine) in
            [(0, 0.0, 1.0), (1, 1.0, 0.0), (2, 0.0, -1.0), (3, -1.0, 0.0)]
        {
            let angle = f64::from(quarters) * std::f64::consts::FRAC_PI_2;
            let (s, c) = sin_cos(angle);
            assert!(
                (s - sine).abs() < 4e-16 && (c - cosine).abs() < 4e-16,
                "{quarters}: {s} {c}"
            );
            let (s, c) = sin_cos(-angle);
            assert!(
                (s + sine).abs() < 4e-16 && (c - cosine).abs() < 4e-16,
                "-{quarters}: {s} {c}"
            );
        }
    }
}
