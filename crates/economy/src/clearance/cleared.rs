//! The share of the mines of a kind that are cleared.
//!
//! Each place that has been neutralised held a mine of the kind with a probability that its marks give, and so does
//! each other place; the number without a mark is Poisson distributed. So the numbers of cleared and of left mines are
//! independent, and their distributions follow. A lane without a mine of the kind is cleared of it.

use super::picture::{BelievedMark, LanePicture};
use alloc::vec;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::MarkVerdict;

/// The interval contains the share with this probability.
const CONFIDENCE: f64 = 0.95;

/// Numbers with a lower probability are left out, at both ends.
const NEGLIGIBLE: f64 = 1e-12;

/// Larger means are not distinguished from this one: almost nothing is cleared.
const MAX_MEAN: f64 = 500.0;

/// Halvings with which the ends of the interval are found.
const HALVINGS: u32 = 48;

/// The share of the mines of a kind that are cleared, as a controller believes it to be.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct ClearedShare {
    /// The number of the kind of items.
    pub kind: usize,
    /// Expected number of mines that have been neutralised.
    pub cleared: f64,
    /// Expected number of mines that are left.
    pub left: f64,
    /// Mean of the share that is cleared, 0 to 1.
    pub share: f64,
    /// Lower end of the interval that contains the share with a probability of at least 95%.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

impl LanePicture {
    /// The share of the mines that are cleared, for each kind that makes the lane unsafe.
    #[must_use]
    pub fn cleared(&self) -> Vec<ClearedShare> {
        let lane = self.clearance().lane;
        let marks = self.marks().filter(|mark| mark.may_be_in(&lane));
        let marks: Vec<BelievedMark> = marks.collect();
        let neutralised = self.neutralised(&marks);
        let each = self.clearance().hazards().map(|(kind, _)| {
            let cells = (0..lane.cells()).map(|cell| self.unmarked_of_kinds(cell)[kind]);
            let unmarked: f64 = cells.sum();
            let open = marks.iter().map(|mark| mark.mine_of_kinds(&lane)[kind]);
            let gone = neutralised.iter().map(|mark| {
                let something: f64 = mark.probabilities.iter().sum();
                // A charge destroys something, or misses.
                if something > 0.0 {
                    (mark.probabilities[kind] / something).min(1.0)
                } else {
                    0.0
                }
            });
            share_of(kind, &Number::of(0.0, gone), &Number::of(unmarked, open))
        });
        each.collect()
    }

    /// Marks at which something has been destroyed; of those that one charge has reached, the first.
    fn neutralised(&self, marks: &[BelievedMark]) -> Vec<BelievedMark> {
        let reach_m = self.clearance().neutralise.map_or(0.0, |of| of.reach_m);
        let mut known: Vec<BelievedMark> = Vec::new();
        let gone = marks.iter();
        for mark in gone.filter(|mark| mark.verdict == Some(MarkVerdict::Neutralised)) {
            let is_known = |one: &BelievedMark| one.at.to(mark.at).length() < reach_m;
            if !known.iter().any(is_known) {
                known.push(*mark);
            }
        }
        known
    }
}

/// The distribution of a number: the probabilities of `first` and of the numbers after it.
#[derive(Debug, Clone)]
struct Number {
    first: usize,
    shares: Vec<f64>,
    mean: f64,
}

impl Number {
    /// The sum of a Poisson distributed number and of one for each probability.
    fn of(poisson: f64, each: impl Iterator<Item = f64>) -> Self {
        let mut number = Self::poisson(poisson);
        for probability in each.filter(|probability| *probability > 0.0) {
            number.add(probability);
        }
        number
    }

    fn poisson(mean: f64) -> Self {
        let bounded = mean.min(MAX_MEAN);
        let mut shares = vec![libm::exp(-bounded)];
        let mut number = 1.0;
        let mut share = shares[0];
        while share > NEGLIGIBLE || number <= bounded {
            share *= bounded / number;
            shares.push(share);
            number += 1.0;
        }
        Self {
            first: 0,
            shares,
            mean,
        }
        .trimmed()
    }

    fn add(&mut self, probability: f64) {
        self.mean += probability;
        self.shares.push(0.0);
        for number in (0..self.shares.len()).rev() {
            let fewer = number
                .checked_sub(1)
                .map_or(0.0, |fewer| self.shares[fewer]);
            self.shares[number] = self.shares[number] * (1.0 - probability) + fewer * probability;
        }
        *self = core::mem::replace(
            self,
            Self {
                first: 0,
                shares: Vec::new(),
                mean: 0.0,
            },
        )
        .trimmed();
    }

    fn trimmed(mut self) -> Self {
        let is_relevant = |share: &f64| *share > NEGLIGIBLE;
        let end = self
            .shares
            .iter()
            .rposition(is_relevant)
            .map_or(1, |last| last + 1);
        self.shares.truncate(end);
        let begin = self.shares.iter().position(is_relevant).unwrap_or_default();
        self.shares.drain(..begin);
        self.first += begin;
        self
    }

    /// The numbers that are possible, with their probabilities.
    #[expect(clippy::cast_precision_loss, reason = "numbers of marks")]
    fn each(&self) -> impl Iterator<Item = (f64, f64)> {
        let numbers = self.shares.iter().enumerate();
        numbers.map(|(number, share)| ((self.first + number) as f64, *share))
    }
}

fn share_of(kind: usize, cleared: &Number, left: &Number) -> ClearedShare {
    let mut mean = 0.0;
    for (gone, likely) in cleared.each() {
        for (still, share) in left.each() {
            mean += likely * share * ratio(gone, still);
        }
    }
    let mean = mean.clamp(0.0, 1.0);
    let outside = (1.0 - CONFIDENCE) / 2.0;
    ClearedShare {
        kind,
        cleared: cleared.mean,
        left: left.mean,
        share: mean,
        // Where almost all of the probability is at one end, the mean is outside the quantiles.
        low: quantile(outside, cleared, left).min(mean),
        high: quantile(1.0 - outside, cleared, left).max(mean),
    }
}

fn ratio(cleared: f64, left: f64) -> f64 {
    if left > 0.0 {
        cleared / (cleared + left)
    } else {
        1.0
    }
}

/// The lowest share that is not exceeded with a probability.
fn quantile(probability: f64, cleared: &Number, left: &Number) -> f64 {
    if up_to(0.0, cleared, left) >= probability {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if up_to(middle, cleared, left) >= probability {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Probability that the share is at most a limit.
fn up_to(limit: f64, cleared: &Number, left: &Number) -> f64 {
    if limit >= 1.0 {
        return 1.0;
    }
    // From many left to few, as more are cleared: each number left is passed once.
    let mut beyond: Vec<(f64, f64)> = Vec::new();
    let mut sum = 0.0;
    for (still, share) in left.each().collect::<Vec<_>>().into_iter().rev() {
        sum += share;
        beyond.push((still, sum));
    }
    let mut total = 0.0;
    for (gone, likely) in cleared.each() {
        let within = beyond
            .iter()
            .take_while(|(still, _)| ratio(gone, *still) <= limit);
        total += likely * within.last().map_or(0.0, |(_, sum)| *sum);
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(cleared: usize, unmarked: f64) -> ClearedShare {
        let gone = core::iter::repeat_n(1.0, cleared);
        share_of(
            0,
            &Number::of(0.0, gone),
            &Number::of(unmarked, core::iter::empty()),
        )
    }

    #[test]
    fn a_lane_without_a_mine_is_cleared() {
        let of = shares(0, 0.02);
        // With no mine found, all of them are cleared if there are none.
        assert!((of.share - libm::exp(-0.02)).abs() < 1e-12, "{of:?}");
        assert_eq!((of.low, of.high), (of.share, 1.0));
        assert!(shares(0, 0.1).low.abs() < 1e-12);
    }

    #[test]
    fn the_interval_has_the_shares_of_possible_numbers() {
        // Of a Poisson number with mean 1, 3 is exceeded in 1.9% of the cases, and 2 in 8.0%.
        let of = shares(12, 1.0);
        assert!((of.low - 12.0 / 15.0).abs() < 1e-9, "{of:?}");
        assert!((of.high - 1.0).abs() < 1e-9, "{of:?}");
        assert!(of.low < of.share && of.share < of.high);
        assert_eq!((of.cleared, of.left), (12.0, 1.0));
    }

    #[test]
    fn uncertain_marks_widen_the_interval() {
        let sure = share_of(
            0,
            &Number::of(0.0, core::iter::repeat_n(1.0, 5)),
            &Number::of(0.01, core::iter::empty()),
        );
        let unsure = share_of(
            0,
            &Number::of(0.0, core::iter::repeat_n(1.0, 5)),
            &Number::of(0.01, [0.5, 0.2].into_iter()),
        );
        assert!(unsure.low < sure.low && unsure.share < sure.share);
        assert!((unsure.left - 0.71).abs() < 1e-12);
    }

    #[test]
    fn many_marks_take_little_work_and_no_probability_is_lost() {
        let gone = Number::of(0.0, core::iter::repeat_n(0.5, 10_000));
        let left = Number::of(1e6, core::iter::repeat_n(0.01, 100));
        assert!(gone.shares.len() < 2_000 && left.shares.len() < 2_000);
        assert!((gone.shares.iter().sum::<f64>() - 1.0).abs() < 1e-8);
        let of = share_of(0, &gone, &left);
        assert!(of.low < of.share && of.share < of.high);
    }
}
