//! The headings of the body in the recent past: a range scan shows what was around the heading at
//! which it was measured, which may be many turns ago.

use alloc::vec::Vec;

/// An interval is exact at first. Of more than this number with the same number of joins, the oldest
/// two are joined: the longer ago, the less exactly a heading is known (an exponential histogram:
/// Datar, Gionis, Indyk and Motwani, *Maintaining stream statistics over sliding windows*, 2002).
const PER_LEVEL: usize = 6;

/// Intervals with this number of joins are forgotten. Some 380 turns are remembered.
const LEVELS: u8 = 6;

/// A body that has just been switched on has been at rest for this time, in seconds: for ever.
const REST_S: f64 = 1e9;

/// Tolerance for the rounding of times, in seconds.
const ROUNDING_S: f64 = 1e-9;

/// The turns of the body.
#[derive(Debug, Clone, Default)]
pub(crate) struct Turns {
    intervals: Vec<Interval>,
    now_s: f64,
    /// The angle turned in total.
    heading_rad: f64,
}

/// A time in which all headings are within bounds. It ends where the next one begins.
#[derive(Debug, Clone, Copy)]
struct Interval {
    begins_s: f64,
    from_rad: f64,
    /// The constant turn rate; `None` if it was joined from several.
    rate_rad_s: Option<f64>,
    joins: u8,
    min_rad: f64,
    max_rad: f64,
}

/// Headings since a moment, relative to the heading at that moment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[expect(clippy::struct_field_names, reason = "they end in the unit")]
pub(crate) struct Headings {
    pub(crate) min_rad: f64,
    pub(crate) max_rad: f64,
    /// Bounds of the heading now.
    pub(crate) now_rad: [f64; 2],
}

impl Headings {
    /// The headings of a single turn.
    #[inline]
    pub(crate) fn turn(turned_rad: f64) -> Self {
        Self {
            min_rad: turned_rad.min(0.0),
            max_rad: turned_rad.max(0.0),
            now_rad: [turned_rad; 2],
        }
    }

    /// Any headings that a body reaches by turning this far.
    pub(crate) fn within(turned_rad: f64) -> Self {
        Self {
            min_rad: -turned_rad,
            max_rad: turned_rad,
            now_rad: [-turned_rad, turned_rad],
        }
    }
}

impl Turns {
    /// Of a body that has been at rest.
    pub(crate) fn at_rest() -> Self {
        let mut turns = Self::default();
        turns.add(REST_S, 0.0);
        turns
    }

    /// Adds a turn at a constant rate.
    pub(crate) fn add(&mut self, elapsed_s: f64, rate_rad_s: f64) {
        let last = self.intervals.last();
        if last.is_none_or(|last| last.rate_rad_s != Some(rate_rad_s)) {
            self.begin(rate_rad_s);
        }
        self.now_s += elapsed_s;
        self.heading_rad += elapsed_s * rate_rad_s;
        if let Some(last) = self.intervals.last_mut() {
            last.min_rad = last.min_rad.min(self.heading_rad);
            last.max_rad = last.max_rad.max(self.heading_rad);
        }
    }

    fn begin(&mut self, rate_rad_s: f64) {
        self.intervals.push(Interval {
            begins_s: self.now_s,
            from_rad: self.heading_rad,
            rate_rad_s: Some(rate_rad_s),
            joins: 0,
            min_rad: self.heading_rad,
            max_rad: self.heading_rad,
        });
        for joins in 0..LEVELS {
            self.join(joins);
        }
    }

    /// Joins the oldest two of too many intervals with this number of joins, or forgets the oldest.
    fn join(&mut self, joins: u8) {
        let mut intervals = self.intervals.iter();
        // Older ones have at least as many joins.
        let oldest = intervals.position(|interval| interval.joins == joins);
        let count = self
            .intervals
            .iter()
            .filter(|interval| interval.joins == joins)
            .count();
        let Some(oldest) = oldest.filter(|_| count > PER_LEVEL) else {
            return;
        };
        let older = self.intervals.remove(oldest);
        if joins + 1 < LEVELS
            && let Some(newer) = self.intervals.get_mut(oldest)
        {
            *newer = older.joined(newer);
        }
    }

    /// Bounds of the headings within the last `age_s`; `None` if it began before the first turn.
    pub(crate) fn within(&self, age_s: f64) -> Option<Headings> {
        let since_s = self.now_s - age_s;
        let mut intervals = self.intervals.iter();
        let has_begun = |interval: &Interval| interval.begins_s <= since_s + ROUNDING_S;
        let first = intervals.rposition(has_begun)?;
        let (begin, later) = self.intervals.get(first..)?.split_first()?;
        let end_rad = later.first().map_or(self.heading_rad, |next| next.from_rad);
        let at_rad = begin.bounds_at(since_s);
        let [mut min_rad, mut max_rad] = match begin.rate_rad_s {
            Some(_) => [at_rad[0].min(end_rad), at_rad[1].max(end_rad)],
            None => at_rad,
        };
        for interval in later {
            min_rad = min_rad.min(interval.min_rad);
            max_rad = max_rad.max(interval.max_rad);
        }
        Some(Headings {
            min_rad: min_rad - at_rad[1],
            max_rad: max_rad - at_rad[0],
            now_rad: [self.heading_rad - at_rad[1], self.heading_rad - at_rad[0]],
        })
    }
}

impl Interval {
    /// Bounds of the heading at a time within it.
    fn bounds_at(&self, time_s: f64) -> [f64; 2] {
        match self.rate_rad_s {
            Some(rate_rad_s) => [self.from_rad + rate_rad_s * (time_s - self.begins_s).max(0.0); 2],
            None => [self.min_rad, self.max_rad],
        }
    }

    /// One interval for this one and the one after it.
    fn joined(&self, next: &Self) -> Self {
        Self {
            rate_rad_s: None,
            joins: self.joins + 1,
            min_rad: self.min_rad.min(next.min_rad),
            max_rad: self.max_rad.max(next.max_rad),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn turns(rates_rad_s: &[f64]) -> Turns {
        let mut turns = Turns::default();
        for rate_rad_s in rates_rad_s {
            turns.add(0.1, *rate_rad_s);
        }
        turns
    }

    #[test]
    fn a_single_turn_has_exact_headings_at_any_age() {
        let turns = turns(&[0.0, 0.0, 1.0, 1.0, 1.0]);
        for (age_s, turned_rad) in [
            (0.05, 0.05),
            (0.1, 0.1),
            (0.25, 0.25),
            (0.3, 0.3),
            (0.4, 0.3),
        ] {
            let Headings {
                min_rad,
                max_rad,
                now_rad,
            } = turns.within(age_s).unwrap();
            assert!(min_rad.abs() < 1e-12);
            for heading_rad in [max_rad, now_rad[0], now_rad[1]] {
                assert!(
                    (heading_rad - turned_rad).abs() < 1e-12,
                    "{age_s}: {heading_rad}"
                );
            }
        }
    }

    #[test]
    fn a_turn_back_is_remembered() {
        let headings = turns(&[1.0, 1.0, -1.0, -1.0]).within(0.4).unwrap();
        assert!((headings.max_rad - 0.2).abs() < 1e-12, "{headings:?}");
        assert!(headings.now_rad[1].abs() < 1e-12, "{headings:?}");
    }

    #[test]
    fn headings_before_the_first_turn_are_unknown() {
        assert_eq!(turns(&[1.0, 0.5]).within(0.3), None);
        assert_eq!(Turns::default().within(0.1), None);
    }

    #[test]
    fn a_body_that_was_at_rest_has_not_turned() {
        let mut turns = Turns::at_rest();
        turns.add(0.1, 1.0);
        let headings = turns.within(60.0).unwrap();
        assert!((headings.max_rad - 0.1).abs() < 1e-12, "{headings:?}");
    }

    #[test]
    fn turns_of_long_ago_are_forgotten() {
        let rates_rad_s: Vec<f64> = (0..2000).map(|step| f64::from(step % 7)).collect();
        let turns = turns(&rates_rad_s);
        assert!(turns.within(30.0).is_some());
        assert_eq!(turns.within(100.0), None);
    }

    proptest! {
        #[test]
        fn headings_are_within_their_bounds_however_long_ago(
            rates_rad_s in proptest::collection::vec(-3.0..3.0_f64, 1..300), age in 1_usize..300,
        ) {
            let age = age.min(rates_rad_s.len());
            let turns = turns(&rates_rad_s);
            prop_assert!(turns.intervals.len() <= PER_LEVEL * usize::from(LEVELS));
            #[expect(clippy::cast_precision_loss, reason = "few")]
            let bounds = turns.within(0.1 * age as f64).unwrap();
            let mut heading_rad = 0.0;
            for rate_rad_s in &rates_rad_s[rates_rad_s.len() - age..] {
                heading_rad += 0.1 * rate_rad_s;
                prop_assert!(bounds.min_rad <= heading_rad + 1e-9, "{bounds:?}");
                prop_assert!(bounds.max_rad >= heading_rad - 1e-9, "{bounds:?}");
            }
            let [low_rad, high_rad] = bounds.now_rad;
            prop_assert!(low_rad <= heading_rad + 1e-9 && heading_rad <= high_rad + 1e-9);
        }

        #[test]
        fn recent_headings_are_exact(
            rates_rad_s in proptest::collection::vec(-3.0..3.0_f64, 1..300), age in 1_usize..6,
        ) {
            let age = age.min(rates_rad_s.len());
            #[expect(clippy::cast_precision_loss, reason = "few")]
            let bounds = turns(&rates_rad_s).within(0.1 * age as f64).unwrap();
            let [low_rad, high_rad] = bounds.now_rad;
            prop_assert!(high_rad - low_rad < 1e-9, "{bounds:?}");
        }
    }
}
