//! The default procedure: if the best configuration is better than every other by delta, it is
//! selected with the stated confidence.
//!
//! All remaining configurations run on; every champion is tested against every challenger (see
//! `betting_test`). For a best configuration that leads by delta, the claim of each test against it
//! is true, so the *mean* of its rivals' evidence is a wealth that cannot be expected to grow; a
//! configuration is eliminated when that mean reaches 1 / alpha. The mean reaches it no later than
//! Bonferroni's correction would allow (one rival's evidence at (k - 1) / alpha), and earlier if
//! several rivals have evidence. The evidence of an eliminated rival is kept as it was at its
//! elimination. A rival that is not tested counts as zero evidence, so any choice of tests is valid:
//! all of them while they are few, else those of the leaders against all others. A new leader gains
//! its evidence from the runs that both already have.

use crate::betting_test::BettingTest;
use crate::interim_analyses::next_analysis;
use crate::problem::Problem;
use crate::procedure::{Elimination, Exclude, Procedure, Request};
use crate::samples::Samples;
use std::collections::BTreeMap;

/// Maximum number of simultaneous tests: every pair of up to a hundred configurations.
const MAX_TESTS: usize = 10_000;

/// The race, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Race {
    problem: Problem,
    samples: Samples,
    survivors: Vec<usize>,
    /// Of each champion, its tests against the survivors, in their order.
    tests: BTreeMap<usize, Vec<BettingTest>>,
    /// Evidence of eliminated champions against each configuration.
    retained: Vec<f64>,
    eliminations: Vec<Elimination>,
}

impl Race {
    /// A race without any runs.
    #[must_use]
    pub fn new(problem: Problem) -> Self {
        let configurations = problem.configurations();
        Self {
            samples: Samples::new(&problem),
            survivors: (0..configurations).collect(),
            tests: BTreeMap::new(),
            retained: vec![0.0; configurations],
            eliminations: Vec::new(),
            problem,
        }
    }

    /// Adds runs of all survivors, a row each; the number of runs may be any.
    fn run(&mut self, merits: &[f64]) {
        self.samples.add(&self.survivors, merits);
        self.choose_champions();
        self.update_tests();
        self.eliminate();
    }

    fn choose_champions(&mut self) {
        let count = (MAX_TESTS / self.survivors.len()).max(1);
        let mut champions = self.samples.by_mean(&self.survivors);
        champions.truncate(count);
        self.tests
            .retain(|champion, _| champions.contains(champion));
        for champion in champions {
            let (bounds, delta) = (&self.problem.bounds, self.problem.delta);
            let test = |other: &usize| BettingTest::new(bounds[champion], bounds[*other], delta);
            self.tests
                .entry(champion)
                .or_insert_with(|| self.survivors.iter().map(test).collect());
        }
    }

    fn update_tests(&mut self) {
        for (&champion, tests) in &mut self.tests {
            for (test, &challenger) in tests.iter_mut().zip(&self.survivors) {
                if challenger != champion {
                    test.advance(self.samples.of(champion), self.samples.of(challenger));
                }
            }
        }
    }

    /// Eliminates all against which there is enough evidence: first those with the most, of equals
    /// the one with the lowest mean. One always remains.
    fn eliminate(&mut self) {
        let mut refuted: Vec<(f64, usize)> = (0..self.survivors.len())
            .map(|index| (self.evidence(index), self.survivors[index]))
            .filter(|(evidence, _)| *evidence >= self.problem.threshold())
            .collect();
        refuted.sort_by(|(more, a), (less, b)| {
            let by_mean = self.samples.mean(*a).total_cmp(&self.samples.mean(*b));
            less.total_cmp(more).then(by_mean).then(b.cmp(a))
        });
        refuted.truncate(self.survivors.len() - 1);
        for (_, challenger) in refuted {
            self.remove(challenger);
        }
    }

    /// The evidence of all champions against the survivor at an index.
    fn evidence(&self, index: usize) -> f64 {
        let challenger = self.survivors[index];
        let rivals = self.tests.iter().filter(|(rival, _)| **rival != challenger);
        let against: f64 = rivals.map(|(_, tests)| tests[index].evidence()).sum();
        self.retained[challenger] + against
    }

    fn remove(&mut self, refuted: usize) {
        let index = self
            .survivors
            .partition_point(|survivor| *survivor < refuted);
        self.eliminations.push(Elimination {
            configuration: refuted,
            by: Some(self.strongest_rival(index)),
            runs: self.samples.runs(refuted) as u64,
        });
        self.survivors.remove(index);
        for tests in self.tests.values_mut() {
            tests.remove(index);
        }
        if let Some(tests) = self.tests.remove(&refuted) {
            for (test, &challenger) in tests.iter().zip(&self.survivors) {
                self.retained[challenger] += test.evidence();
            }
        }
    }

    /// Of the remaining champions, the one with the most evidence against the survivor at an index;
    /// of equals, the one with the highest mean.
    fn strongest_rival(&self, index: usize) -> usize {
        let champions: Vec<usize> = self.tests.keys().copied().collect();
        let mut rivals = self.samples.by_mean(&champions);
        rivals.retain(|rival| *rival != self.survivors[index]);
        let evidence = |rival: &usize| self.tests[rival][index].evidence();
        rivals
            .into_iter()
            .rev()
            .max_by(|a, b| evidence(a).total_cmp(&evidence(b)))
            .unwrap_or_else(|| self.survivors[0])
    }
}

impl Procedure for Race {
    fn next(&self) -> Option<Request> {
        let runs = self.samples.runs(*self.survivors.first()?);
        (self.survivors.len() > 1 || runs == 0).then(|| Request {
            configurations: self.survivors.clone(),
            first_run: runs as u64,
            runs: next_analysis(runs) - runs,
        })
    }

    fn record(&mut self, merits: &[f64]) {
        self.run(merits);
    }

    fn selected(&self) -> Option<usize> {
        self.samples.by_mean(&self.survivors).first().copied()
    }

    fn runs(&self) -> Vec<u64> {
        self.samples.all_runs()
    }

    fn survivors(&self) -> Vec<usize> {
        self.survivors.clone()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        self.eliminations.clone()
    }
}

impl Exclude for Race {
    fn exclude(&mut self, configurations: &[usize]) {
        self.survivors.retain(|each| !configurations.contains(each));
    }
}
