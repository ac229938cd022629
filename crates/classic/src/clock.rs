//! Time, counted in paints of the original's window: when the team decides, and seconds.

use std::ops::RangeInclusive;

/// Maximum time limit of a run, in paints, so that a run that never ends is not computed for minutes.
pub const MAX_TIME_LIMIT_PAINTS: u64 = 1_000_000;

pub(crate) const PAINTS_PER_S: RangeInclusive<f64> = 0.1..=1000.0;

/// The conversion of paints to seconds, and the time limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Number of paints per second.
    pub paints_per_s: f64,
    /// A run that takes longer has failed, and counts as this long.
    pub time_limit_s: f64,
    /// The last paint within the time limit.
    pub time_limit_paints: u64,
}

impl Clock {
    /// A clock, unless the time limit is more than [`MAX_TIME_LIMIT_PAINTS`].
    #[must_use]
    pub fn new(paints_per_s: f64, time_limit_s: f64) -> Option<Self> {
        let time_limit_paints = whole_paints(paints_per_s * time_limit_s);
        (time_limit_paints <= MAX_TIME_LIMIT_PAINTS).then_some(Self {
            paints_per_s,
            time_limit_s,
            time_limit_paints,
        })
    }
}

/// The number of paints within a time. 4.35 s at 100 paints per second are 435 paints, although the
/// product of the two floats is slightly less.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the ranges of both factors keep it from 0 to 1e9"
)]
fn whole_paints(paints: f64) -> u64 {
    (paints + 1e-6).floor() as u64
}

/// Paint of the first decision.
pub const FIRST_DECISION: u64 = 12;

/// Paints between two decisions.
pub const DECISION_PERIOD: u64 = 11;

/// Whether the team decides in a paint: 12, 23, 34, ...
pub(crate) fn is_decision(paint: u64) -> bool {
    paint >= FIRST_DECISION && (paint - FIRST_DECISION).is_multiple_of(DECISION_PERIOD)
}

/// Number of paints until the next decision.
pub(crate) fn decides_in(paint: u64) -> u64 {
    match paint.checked_sub(FIRST_DECISION) {
        None => FIRST_DECISION - paint,
        Some(since) => DECISION_PERIOD - since % DECISION_PERIOD,
    }
}

/// The paint of a decision; decisions are counted from 1, and 0 is the start.
pub(crate) fn paint_of(decision: u64) -> u64 {
    match decision {
        0 => 0,
        _ => FIRST_DECISION + DECISION_PERIOD * (decision - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_limit_that_floats_cannot_hold_is_still_whole_paints() {
        assert_eq!(whole_paints(4.35 * 100.0), 435);
        assert_eq!(whole_paints(120.0 * 56.0), 6720);
        assert_eq!(whole_paints(0.0), 0);
        assert_eq!(whole_paints(6720.9), 6720);
    }

    #[test]
    fn the_paint_of_a_decision_is_when_the_team_decides() {
        let decisions = (1..=500).filter(|paint| is_decision(*paint));
        assert!(
            decisions
                .zip(1..)
                .all(|(paint, decision)| paint_of(decision) == paint)
        );
    }

    #[test]
    fn the_team_decides_after_that_number_of_paints_and_not_before() {
        for paint in 0..100 {
            let next = paint + decides_in(paint);
            assert!(is_decision(next));
            assert!((paint + 1..next).all(|between| !is_decision(between)));
        }
    }
}
