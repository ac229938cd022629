//! Evidence that a probability is above a limit, from successes and failures.
//!
//! Each bettor assumes a probability q above the limit and multiplies its wealth by the ratio of the
//! likelihoods of q and of the limit. If the probability is at most the limit, no wealth can be
//! expected to grow, and so neither can their mean, which by Ville's inequality ever reaches w with
//! a probability of at most 1 / w. It may therefore be evaluated after every run. Wealth depends only
//! on the numbers of successes and failures.
//!
//! Half of the wealth belongs to a bettor that assumes the alternative which the test must separate
//! from the limit: that is Wald's sequential test. The others share the rest; the odds that they
//! assume double from one to the next, since a probability far above the limit is shown much sooner
//! by a bettor that assumes it.
//!
//! Source: Wald (1945), Sequential tests of statistical hypotheses, Annals of Mathematical Statistics
//! 16; Waudby-Smith and Ramdas (2024), Estimating means of bounded random variables by betting,
//! Journal of the Royal Statistical Society B 86, section 4.

/// Bettors besides Wald's.
const BOLDER: i32 = 8;

/// The part of the wealth of Wald's bettor.
const WALD: f64 = 0.5;

/// The bettors of one test. They are the same for all configurations.
#[derive(Debug, Clone)]
pub(crate) struct ProportionTest(Vec<Bettor>);

/// Logarithms of a bettor's wealth at the start, and of what a success and a failure multiply it by.
#[derive(Debug, Clone, Copy)]
struct Bettor {
    start: f64,
    success: f64,
    failure: f64,
}

impl ProportionTest {
    /// A test of the claim that a probability is at most `limit`, in 0..1, which must be refuted if it
    /// is `alternative`, above the limit and at most 1.
    pub(crate) fn new(limit: f64, alternative: f64) -> Self {
        let bettor = |part: f64, assumed: f64| Bettor {
            start: libm::log(part),
            success: libm::log(assumed / limit),
            failure: libm::log((1.0 - assumed) / (1.0 - limit)),
        };
        let mut bettors = vec![bettor(WALD, alternative)];
        let odds = alternative / (1.0 - alternative);
        if odds.is_finite() {
            bettors.extend((1..=BOLDER).map(|doublings| {
                let odds = odds * libm::exp2(f64::from(doublings));
                bettor((1.0 - WALD) / f64::from(BOLDER), odds / (1.0 + odds))
            }));
        }
        Self(bettors)
    }

    /// Whether the evidence against the claim reaches `goal`, a logarithm.
    #[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
    pub(crate) fn reaches(&self, goal: f64, successes: u64, failures: u64) -> bool {
        // 0 x infinity is no result: an impossible outcome that did not occur changes nothing.
        let times = |count: u64, log: f64| if count == 0 { 0.0 } else { count as f64 * log };
        let log_wealth = |bettor: &Bettor| {
            bettor.start + times(successes, bettor.success) + times(failures, bettor.failure)
        };
        let most = self
            .0
            .iter()
            .map(log_wealth)
            .fold(f64::NEG_INFINITY, f64::max);
        let count = self.0.len() as f64;
        if most >= goal || most < goal - libm::log(count) {
            return most >= goal;
        }
        let shares = self
            .0
            .iter()
            .map(|bettor| libm::exp(log_wealth(bettor) - goal));
        shares.sum::<f64>() >= 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The evidence itself, up to the rounding of 60 halvings.
    fn evidence(test: &ProportionTest, successes: u64, failures: u64) -> f64 {
        let (mut low, mut high) = (-800.0, 800.0);
        for _ in 0..60 {
            let goal = f64::midpoint(low, high);
            if test.reaches(goal, successes, failures) {
                low = goal;
            } else {
                high = goal;
            }
        }
        libm::exp(low)
    }

    #[test]
    fn successes_alone_show_a_high_probability_and_failures_never_do() {
        let test = ProportionTest::new(0.95, 0.97);
        let goal = libm::log(20.0);
        // 59 successes if their number is fixed beforehand: log(20) / log(1 / 0.95).
        let runs = (0..1000).find(|runs| test.reaches(goal, *runs, 0));
        assert!((59..150).contains(&runs.unwrap()), "{runs:?}");
        assert!((0..1000).all(|failures| !test.reaches(goal, 0, failures)));
    }

    #[test]
    fn one_impossible_outcome_decides() {
        // The claim that nothing ever succeeds.
        let never = ProportionTest::new(0.0, 0.05);
        assert!(!never.reaches(10.0, 0, 1000) && never.reaches(10.0, 1, 1000));
        // The assumption that everything succeeds.
        let always = ProportionTest::new(0.95, 1.0);
        assert!(always.reaches(1.0, 100, 0) && !always.reaches(-700.0, 100, 1));
    }

    proptest! {
        #[test]
        fn evidence_cannot_be_expected_to_grow_at_the_limit(
            limit in 0.01..0.98_f64, share in 0.01..0.99_f64, successes in 0_u64..200, failures in 0_u64..200,
        ) {
            let test = ProportionTest::new(limit, limit + share * (1.0 - limit));
            let now = evidence(&test, successes, failures);
            prop_assume!(now > 1e-300 && now < 1e300);
            let next = limit * evidence(&test, successes + 1, failures)
                + (1.0 - limit) * evidence(&test, successes, failures + 1);
            prop_assert!((next / now - 1.0).abs() < 1e-9, "{now} {next}");
        }

        #[test]
        fn below_the_limit_evidence_is_expected_to_shrink(
            limit in 0.05..0.95_f64, below in 0.0..1.0_f64, successes in 0_u64..50, failures in 0_u64..50,
        ) {
            let test = ProportionTest::new(limit, f64::midpoint(limit, 1.0));
            let (now, p) = (evidence(&test, successes, failures), below * limit);
            let next = p * evidence(&test, successes + 1, failures)
                + (1.0 - p) * evidence(&test, successes, failures + 1);
            prop_assert!(next <= now * (1.0 + 1e-9), "{now} {next}");
        }
    }
}
