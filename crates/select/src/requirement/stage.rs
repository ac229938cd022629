//! One question about all configurations, at one tolerance: its tests, and what they have shown.

use crate::proportion_test::ProportionTest;

/// What is known of a configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    /// Neither of the others yet.
    Open,
    /// It meets the requirement.
    Certified,
    /// It does not meet it with tolerance to spare.
    Refuted,
    /// It cannot be run.
    Excluded,
}

/// The limits between which shares are not distinguished, and the allowed errors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) probability: f64,
    pub(super) tolerance: f64,
    /// Of certifying any of all configurations wrongly; refuting may err as often.
    pub(super) error: f64,
    /// Of showing wrongly that a share is below `probability`.
    pub(super) below_error: f64,
    /// Number of configurations.
    pub(super) count: usize,
    /// Whether a share that is below `probability` by more than the tolerance must be shown to be so before it
    /// is refuted.
    pub(super) needs_below: bool,
}

/// A test, and the evidence at which it decides, as a logarithm.
#[derive(Debug, Clone)]
struct Decision {
    test: ProportionTest,
    at: f64,
}

impl Decision {
    fn is_reached(&self, successes: u64, failures: u64) -> bool {
        self.test.reaches(self.at, successes, failures)
    }
}

/// The tests of a configuration; they are the same for all.
#[derive(Debug, Clone)]
pub(super) struct Tests {
    certify: Decision,
    /// These two exchange successes and failures: they test against a high probability.
    refute: Decision,
    below: Decision,
    limits: Limits,
}

impl Tests {
    #[expect(
        clippy::cast_precision_loss,
        reason = "configurations are far fewer than 2^53"
    )]
    pub(super) fn new(limits: Limits) -> Self {
        let spare = limits.probability + limits.tolerance;
        let missed = 1.0 - limits.probability;
        let often = (missed + limits.tolerance).min(f64::midpoint(missed, 1.0));
        Self {
            certify: Decision {
                test: ProportionTest::new(limits.probability, spare.min(1.0)),
                at: libm::log(limits.count as f64 / limits.error),
            },
            refute: Decision {
                test: ProportionTest::new((1.0 - spare).max(0.0), missed),
                at: libm::log(1.0 / limits.error),
            },
            below: Decision {
                test: ProportionTest::new(missed, often),
                at: libm::log(1.0 / limits.below_error),
            },
            limits,
        }
    }

    /// What the runs of a configuration show.
    pub(super) fn status(&self, met: u64, missed: u64) -> Status {
        if self.certify.is_reached(met, missed) {
            Status::Certified
        } else if self.refute.is_reached(missed, met) && self.is_below_enough(met, missed) {
            Status::Refuted
        } else {
            Status::Open
        }
    }

    /// Whether they show that its probability is below that of the requirement.
    fn is_below(&self, met: u64, missed: u64) -> bool {
        self.below.is_reached(missed, met)
    }

    #[expect(clippy::cast_precision_loss, reason = "runs are far fewer than 2^53")]
    fn is_below_enough(&self, met: u64, missed: u64) -> bool {
        let nearest = self.limits.probability - self.limits.tolerance;
        let is_near = met as f64 >= nearest * (met + missed) as f64;
        !self.limits.needs_below || is_near || self.is_below(met, missed)
    }
}

/// A question, between two rounds.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    tests: Tests,
    pub(super) statuses: Vec<Status>,
    /// Whether the probability of each was shown to be below that of the requirement.
    pub(super) below: Vec<bool>,
}

impl Stage {
    pub(super) fn new(limits: Limits) -> Self {
        Self {
            tests: Tests::new(limits),
            statuses: vec![Status::Open; limits.count],
            below: vec![false; limits.count],
        }
    }

    /// Takes the numbers of a configuration's runs into account; returns whether they refute it, which was open.
    pub(super) fn decide(&mut self, configuration: usize, met: u64, missed: u64) -> bool {
        self.below[configuration] |= self.tests.is_below(met, missed);
        let status = &mut self.statuses[configuration];
        if *status != Status::Open {
            return false;
        }
        *status = self.tests.status(met, missed);
        *status == Status::Refuted
    }
}
