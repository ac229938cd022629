//! A test by betting: the evidence that a champion gathers against a challenger.
//!
//! The claim under test: the challenger's mean merit is above the champion's by delta or more. In
//! every run, x = champion - challenger + delta; under the claim its mean is at most 0, and it is
//! never below -depth, because merits are bounded. A gambler that starts with 1 and stakes a part of
//! the wealth on x, bet x wealth with bet < 1 / depth, cannot expect to gain under the claim:
//! the wealth is a nonnegative supermartingale, and by Ville's inequality it ever reaches w with a
//! probability of at most 1 / w. So wealth is evidence against the claim, and may be evaluated at
//! any moment.
//!
//! The size of the bets decides how many runs a test takes, but never its validity, as long as a bet
//! is fixed before the runs on which it is made. Five gamblers share the first 1 equally. Three make
//! the best bet (Kelly) if x has its variance so far and a mean of 1, 2 or 4 delta: a mean of delta
//! is that of two equal configurations, and a claim that is further from the truth is refuted
//! sooner. The fourth assumes that the mean of x is its mean so far, which is best if delta is small
//! beside the difference. These four bet at most 0.7 of the limit, so that a rare loss that has not
//! occurred yet cannot ruin them. The fifth always stakes 0.9 of it, which is fastest against much
//! worse challengers, and if common random numbers leave little variance.
//!
//! Source: Waudby-Smith and Ramdas (2024), Estimating means of bounded random variables by betting,
//! Journal of the Royal Statistical Society B 86, sections 4 and 5; Ville (1939), Etude critique de
//! la notion de collectif.

use crate::interim_analyses::next_analysis;
use crate::problem::Bounds;

/// Multiples of delta that three gamblers assume as the mean. The first must be 1: against an equal
/// configuration, a bet of twice the best one wins nothing.
const MEANS: [f64; 3] = [1.0, 2.0, 4.0];
const GAMBLERS: usize = MEANS.len() + 2;

/// Maximum bets of the first four gamblers and the bet of the fifth, as parts of the limit.
const CAUTIOUS: f64 = 0.7;
const BOLD: f64 = 0.9;

/// The variance before the first run, as a part of the squared depth; it weighs as much as one run.
const PRIOR_VARIANCE: f64 = 0.25;

/// Part of delta by which rounding may shift the greatest difference that bounds allow.
const ROUNDING: f64 = 1e-9;

/// The evidence of one champion against one challenger.
#[derive(Debug, Clone)]
pub(crate) struct BettingTest {
    depth: f64,
    delta: f64,
    used: usize,
    next_analysis: usize,
    sum: f64,
    sum_of_squares: f64,
    bets: [f64; GAMBLERS],
    wealth: [f64; GAMBLERS],
    peak: f64,
}

impl BettingTest {
    #[expect(clippy::cast_precision_loss, reason = "there are five gamblers")]
    pub(crate) fn new(champion: Bounds, challenger: Bounds, delta: f64) -> Self {
        let depth = challenger.max - champion.min - delta;
        let mut test = Self {
            // If x cannot fall below 0, any depth above 0 is valid.
            depth: depth.max(ROUNDING * delta),
            delta,
            used: 0,
            next_analysis: next_analysis(0),
            sum: 0.0,
            sum_of_squares: 0.0,
            bets: [0.0; GAMBLERS],
            wealth: [1.0 / GAMBLERS as f64; GAMBLERS],
            peak: 0.0,
        };
        if depth < -ROUNDING * delta {
            // The bounds alone refute the claim.
            test.wealth = [f64::INFINITY; GAMBLERS];
            test.peak = f64::INFINITY;
        } else {
            test.place_bets();
        }
        test
    }

    /// Bets on the runs that both have and that are new. Their division into calls makes no
    /// difference: bets change at interim analyses.
    pub(crate) fn advance(&mut self, champion: &[f64], challenger: &[f64]) {
        self.advance_until(champion, challenger, f64::INFINITY);
    }

    /// The same, but stops at the interim analysis at which the evidence reaches `enough`.
    pub(crate) fn advance_until(&mut self, champion: &[f64], challenger: &[f64], enough: f64) {
        let end = champion.len().min(challenger.len());
        while self.used < end && self.peak < enough {
            let stop = end.min(self.next_analysis);
            let (champion, challenger) = (&champion[self.used..stop], &challenger[self.used..stop]);
            for (champion, challenger) in champion.iter().zip(challenger) {
                self.bet_on(champion - challenger + self.delta);
            }
            self.used = stop;
            if stop == self.next_analysis {
                self.next_analysis = next_analysis(stop);
                self.peak = self.peak.max(self.evidence());
                self.place_bets();
            }
        }
    }

    /// The gamblers' wealth; under the claim it reaches w with a probability of at most 1 / w.
    pub(crate) fn evidence(&self) -> f64 {
        self.wealth.iter().sum()
    }

    /// The maximum of the evidence over all interim analyses.
    pub(crate) fn peak(&self) -> f64 {
        self.peak
    }

    /// Runs that it has used.
    pub(crate) fn used(&self) -> usize {
        self.used
    }

    fn bet_on(&mut self, x: f64) {
        self.sum += x;
        self.sum_of_squares += x * x;
        for (wealth, bet) in self.wealth.iter_mut().zip(&self.bets) {
            *wealth *= 1.0 + bet * x;
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
    fn place_bets(&mut self) {
        let runs = self.used as f64;
        let mean = self.sum / runs.max(1.0);
        let spread = (self.sum_of_squares - self.sum * mean).max(0.0);
        let variance = (PRIOR_VARIANCE * self.depth * self.depth + spread) / (runs + 1.0);
        let limit = 1.0 / self.depth;
        let [cautious @ .., adaptive, bold] = &mut self.bets;
        let best = |mean: f64| (mean / (variance + mean * mean)).min(CAUTIOUS * limit);
        for (bet, multiple) in cautious.iter_mut().zip(MEANS) {
            *bet = best(multiple * self.delta);
        }
        *adaptive = best(mean.max(self.delta));
        *bold = BOLD * limit;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const UNIT: Bounds = Bounds { min: 0.0, max: 1.0 };

    #[test]
    fn bounds_alone_can_refute_a_claim() {
        let low = Bounds {
            min: -1.0,
            max: 0.05,
        };
        assert!(BettingTest::new(UNIT, low, 0.1).evidence().is_infinite());
        assert!(BettingTest::new(low, UNIT, 0.1).evidence().is_finite());
    }

    proptest! {
        #[test]
        fn the_division_of_runs_into_calls_makes_no_difference(
            merits in prop::collection::vec((0.0..=1.0, 0.0..=1.0), 1..400), cut in 0usize..400,
        ) {
            let (champion, challenger): (Vec<f64>, Vec<f64>) = merits.into_iter().unzip();
            let cut = cut.min(champion.len());
            let mut whole = BettingTest::new(UNIT, UNIT, 0.1);
            whole.advance(&champion, &challenger);
            let mut parts = BettingTest::new(UNIT, UNIT, 0.1);
            parts.advance(&champion[..cut], &challenger);
            parts.advance(&champion, &challenger);
            prop_assert_eq!(whole.evidence().to_bits(), parts.evidence().to_bits());
        }

        #[test]
        fn one_run_wins_nothing_on_average_under_the_claim(high in 0.0..=0.9f64, delta in 0.01..0.5f64) {
            // A challenger that is 1 where the champion is `high`, with the odds that make its mean
            // lead exactly delta: the two possible wealths then average to the start.
            let (up, down) = (1.0 - high, high);
            prop_assume!(up > delta && down > 0.0);
            let share = (delta + down) / (up + down);
            let after = |champion: f64, challenger: f64| {
                let mut test = BettingTest::new(UNIT, UNIT, delta);
                test.advance(&[champion], &[challenger]);
                test.evidence()
            };
            let mean = share * after(high, 1.0) + (1.0 - share) * after(high, 0.0);
            prop_assert!((mean - 1.0).abs() < 1e-9, "{}", mean);
        }
    }
}
