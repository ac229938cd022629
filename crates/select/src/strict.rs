//! The strict procedure: the selected configuration is within delta of the best with the stated
//! confidence, whatever the true means are.
//!
//! The leader by mean must itself refute, against every other configuration, that the other is
//! better by delta or more (see `betting_test`), each at alpha / (k - 1). For the true best and a
//! selected configuration that is worse by delta or more, that claim is true; so a wrong selection
//! requires an error in one of at most k - 1 tests against the best, which has a probability of at
//! most alpha. (The race does not prove this much: there a configuration may be eliminated by one
//! that is eliminated itself, and the two steps add up to two deltas.)
//!
//! Only the leader and those that it has not refuted run on. A new leader is tested over the runs
//! that both already have; those that these do not refute return and run on from where they stopped.

use crate::betting_test::BettingTest;
use crate::interim_analyses::next_analysis;
use crate::problem::{Bounds, Problem};
use crate::procedure::{Elimination, Exclude, Procedure, Request};
use crate::samples::Samples;
use std::collections::BTreeSet;

/// The strict procedure, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Strict {
    problem: Problem,
    samples: Samples,
    leader: usize,
    /// Those that the leader has not refuted, ascending.
    challengers: Vec<usize>,
    /// The leader's tests against all.
    tests: Vec<BettingTest>,
    excluded: BTreeSet<usize>,
}

impl Strict {
    /// A procedure without any runs.
    #[must_use]
    pub fn new(problem: Problem) -> Self {
        let configurations = problem.configurations();
        Self {
            samples: Samples::new(&problem),
            leader: 0,
            challengers: (1..configurations).collect(),
            tests: Vec::new(),
            excluded: BTreeSet::new(),
            problem,
        }
    }

    fn choose_leader(&mut self) {
        let leader = self.samples.by_mean(&self.survivors()).first().copied();
        let leader = leader.unwrap_or(self.leader);
        if leader != self.leader || self.tests.is_empty() {
            let (bounds, delta) = (&self.problem.bounds, self.problem.delta);
            let test = |other: &Bounds| BettingTest::new(bounds[leader], *other, delta);
            self.tests = bounds.iter().map(test).collect();
            self.leader = leader;
        }
    }

    fn update_tests(&mut self) {
        let threshold = self.problem.threshold();
        self.challengers.clear();
        for (other, test) in self.tests.iter_mut().enumerate() {
            if other == self.leader || self.excluded.contains(&other) {
                continue;
            }
            let (leader, challenger) = (self.samples.of(self.leader), self.samples.of(other));
            test.advance_until(leader, challenger, threshold);
            if test.peak() < threshold {
                self.challengers.push(other);
            }
        }
    }
}

impl Procedure for Strict {
    /// The survivors with the fewest runs are next, so that those that returned catch up.
    fn next(&self) -> Option<Request> {
        let survivors = self.survivors();
        let runs = |configuration: &usize| self.samples.runs(*configuration);
        let fewest = survivors.iter().map(runs).min()?;
        let mut configurations = survivors;
        configurations.retain(|configuration| runs(configuration) == fewest);
        (!self.challengers.is_empty() || fewest == 0).then(|| Request {
            configurations,
            first_run: fewest as u64,
            runs: next_analysis(fewest) - fewest,
        })
    }

    fn record(&mut self, merits: &[f64]) {
        if let Some(request) = self.next() {
            self.samples.add(&request.configurations, merits);
            self.choose_leader();
            self.update_tests();
        }
    }

    fn selected(&self) -> Option<usize> {
        Some(self.leader)
    }

    fn runs(&self) -> Vec<u64> {
        self.samples.all_runs()
    }

    /// The leader and those it has not refuted.
    fn survivors(&self) -> Vec<usize> {
        let mut survivors = self.challengers.clone();
        let place = survivors.partition_point(|challenger| *challenger < self.leader);
        survivors.insert(place, self.leader);
        survivors
    }

    /// Those that the current leader has refuted, and with how many runs of both.
    fn eliminations(&self) -> Vec<Elimination> {
        let threshold = self.problem.threshold();
        let is_refuted = |(other, test): &(usize, &BettingTest)| {
            *other != self.leader && test.peak() >= threshold
        };
        let mut eliminations: Vec<Elimination> = self
            .tests
            .iter()
            .enumerate()
            .filter(is_refuted)
            .map(|(other, test)| Elimination {
                configuration: other,
                by: Some(self.leader),
                runs: test.used() as u64,
            })
            .collect();
        eliminations.sort_by_key(|elimination| (elimination.runs, elimination.configuration));
        eliminations
    }
}

impl Exclude for Strict {
    fn exclude(&mut self, configurations: &[usize]) {
        self.excluded.extend(configurations);
        let mut remaining = self.survivors();
        remaining.retain(|each| !self.excluded.contains(each));
        if let Some((leader, challengers)) = remaining.split_first() {
            self.leader = *leader;
            self.challengers = challengers.to_vec();
        }
    }
}
