//! Seconds and paints.

use base::document::Section;
use base::engine::MAX_CAP_S;
use std::ops::RangeInclusive;

/// Paints that a run may be counted for, so that one that never ends is not computed for minutes.
pub const MAX_CAP_PAINTS: u64 = 1_000_000;

pub(super) const PAINTS_PER_S: RangeInclusive<f64> = 0.1..=1000.0;
pub(super) const CAP_S: RangeInclusive<f64> = 0.0..=MAX_CAP_S;

/// How paints are seconds, and when a search has failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Turns paints into seconds.
    pub paints_per_s: f64,
    /// A run that takes longer has failed, and counts as this long.
    pub time_limit_s: f64,
    /// The last paint that is not beyond the cap.
    pub cap_paints: u64,
}

pub(super) fn clock(section: &Section) -> Option<Clock> {
    section.only(&["paints_per_s", "time_limit_s"]);
    let paints_per_s = section.number("paints_per_s", PAINTS_PER_S);
    let time_limit_s = section.number("time_limit_s", CAP_S);
    let (paints_per_s, time_limit_s) = (paints_per_s?, time_limit_s?);
    let cap_paints = whole_paints(paints_per_s * time_limit_s);
    if cap_paints > MAX_CAP_PAINTS {
        let allowed =
            format!("at most {MAX_CAP_PAINTS} paints at {paints_per_s} paints per second");
        section.error("time_limit_s", &allowed);
        return None;
    }
    Some(Clock {
        paints_per_s,
        time_limit_s,
        cap_paints,
    })
}

/// The paints within a time. 4.35 s at 100 a second are 435 paints, though the product of the two
/// floats is a little less.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the ranges of both factors keep it from 0 to 1e9"
)]
fn whole_paints(paints: f64) -> u64 {
    (paints + 1e-6).floor() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_that_floats_cannot_hold_is_still_whole_paints() {
        assert_eq!(whole_paints(4.35 * 100.0), 435);
        assert_eq!(whole_paints(120.0 * 56.0), 6720);
        assert_eq!(whole_paints(0.0), 0);
        assert_eq!(whole_paints(6720.9), 6720);
    }
}
