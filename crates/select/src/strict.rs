//! The strict procedure: whatever the truth, the selected configuration is within delta of the best
//! with the stated confidence.
//!
//! The leader by mean must itself refute, against every other configuration, that the other is
//! better by delta or more (see `duel`), each at alpha / (k - 1). For the true best and a selected
//! configuration that is worse by delta or more, that claim is true; so a wrong selection needs one
//! of at most k - 1 duels against the best to go wrong, which happens with a probability of at most
//! alpha. (The race does not prove this much: there a configuration may be put out by one that is
//! put out itself, and the two steps add up to two deltas.)
//!
//! Only the leader and those it has not refuted yet run on. A new leader duels over the runs that
//! both have had; those it cannot refute with these come back and run on from where they were.

use crate::duel::Duel;
use crate::problem::{Bounds, Problem};
use crate::procedure::{Elimination, Procedure, Request};
use crate::samples::Samples;
use crate::schedule::next_look;

/// The strict procedure, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Strict {
    problem: Problem,
    samples: Samples,
    leader: usize,
    /// Those that the leader has not refuted, ascending.
    challengers: Vec<usize>,
    /// The leader's duels with all.
    duels: Vec<Duel>,
}

impl Strict {
    /// A procedure in which nobody has run yet.
    #[must_use]
    pub fn new(problem: Problem) -> Self {
        let configurations = problem.configurations();
        Self {
            samples: Samples::new(&problem),
            leader: 0,
            challengers: (1..configurations).collect(),
            duels: Vec::new(),
            problem,
        }
    }

    fn choose_leader(&mut self) {
        let leader = self.samples.by_mean(&self.survivors()).first().copied();
        let leader = leader.unwrap_or(self.leader);
        if leader != self.leader || self.duels.is_empty() {
            let (bounds, delta) = (&self.problem.bounds, self.problem.delta);
            let duel = |other: &Bounds| Duel::new(bounds[leader], *other, delta);
            self.duels = bounds.iter().map(duel).collect();
            self.leader = leader;
        }
    }

    fn fight(&mut self) {
        let threshold = self.problem.threshold();
        self.challengers.clear();
        for (other, duel) in self.duels.iter_mut().enumerate() {
            if other == self.leader {
                continue;
            }
            let (leader, challenger) = (self.samples.of(self.leader), self.samples.of(other));
            duel.advance_until(leader, challenger, threshold);
            if duel.peak() < threshold {
                self.challengers.push(other);
            }
        }
    }
}

impl Procedure for Strict {
    /// The survivors with the fewest runs go on, so that those that came back catch up.
    fn next(&self) -> Option<Request> {
        let survivors = self.survivors();
        let runs = |configuration: &usize| self.samples.runs(*configuration);
        let fewest = survivors.iter().map(runs).min()?;
        let mut configurations = survivors;
        configurations.retain(|configuration| runs(configuration) == fewest);
        (!self.challengers.is_empty() || fewest == 0).then(|| Request {
            configurations,
            first_run: fewest as u64,
            runs: next_look(fewest) - fewest,
        })
    }

    fn tell(&mut self, merits: &[f64]) {
        if let Some(asked) = self.next() {
            self.samples.add(&asked.configurations, merits);
            self.choose_leader();
            self.fight();
        }
    }

    fn best(&self) -> usize {
        self.leader
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

    /// What the present leader has refuted, and with how many runs of both.
    fn eliminations(&self) -> Vec<Elimination> {
        let threshold = self.problem.threshold();
        let is_out =
            |(other, duel): &(usize, &Duel)| *other != self.leader && duel.peak() >= threshold;
        let mut out: Vec<Elimination> = self
            .duels
            .iter()
            .enumerate()
            .filter(is_out)
            .map(|(other, duel)| Elimination {
                configuration: other,
                by: self.leader,
                runs: duel.seen() as u64,
            })
            .collect();
        out.sort_by_key(|elimination| (elimination.runs, elimination.configuration));
        out
    }
}
