//! The default procedure: if the best configuration is better than every other by delta, it is
//! selected with the stated confidence.
//!
//! All that are still in run on; every champion duels with every challenger (see `duel`). Against a
//! best that leads by delta, the claim of each of its duels is true, so the *mean* of its rivals'
//! evidence is a wealth that cannot be expected to grow; a configuration is out when that mean
//! reaches 1 / alpha. A mean is never less than what Bonferroni's correction allows (one rival's
//! evidence at (k - 1) / alpha), and more where several rivals have some. The evidence of a rival
//! stays when it is out itself, as it was then. A rival that is not asked counts as none, so which
//! duels are fought is free: all while they are few, else those of the leaders with all others.
//! A leader that is new to the role has its evidence from the runs that both have had already.

use crate::duel::Duel;
use crate::problem::Problem;
use crate::procedure::{Elimination, Procedure, Request};
use crate::samples::Samples;
use crate::schedule::next_look;
use std::collections::BTreeMap;

/// Duels fought at a time: up to a hundred configurations, every pair.
const MAX_DUELS: usize = 10_000;

/// The race, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Race {
    problem: Problem,
    samples: Samples,
    survivors: Vec<usize>,
    /// Of each champion, its duels with the survivors, in their order.
    duels: BTreeMap<usize, Vec<Duel>>,
    /// Evidence against each configuration of champions that are out.
    bequeathed: Vec<f64>,
    eliminations: Vec<Elimination>,
}

impl Race {
    /// A race in which nobody has run yet.
    #[must_use]
    pub fn new(problem: Problem) -> Self {
        let configurations = problem.configurations();
        Self {
            samples: Samples::new(&problem),
            survivors: (0..configurations).collect(),
            duels: BTreeMap::new(),
            bequeathed: vec![0.0; configurations],
            eliminations: Vec::new(),
            problem,
        }
    }

    /// Adds runs of all survivors, a row each; rounds may have any length.
    fn run(&mut self, merits: &[f64]) {
        self.samples.add(&self.survivors, merits);
        self.choose_champions();
        self.fight();
        self.eliminate();
    }

    fn choose_champions(&mut self) {
        let count = (MAX_DUELS / self.survivors.len()).max(1);
        let mut champions = self.samples.by_mean(&self.survivors);
        champions.truncate(count);
        self.duels
            .retain(|champion, _| champions.contains(champion));
        for champion in champions {
            let (bounds, delta) = (&self.problem.bounds, self.problem.delta);
            let duel = |other: &usize| Duel::new(bounds[champion], bounds[*other], delta);
            self.duels
                .entry(champion)
                .or_insert_with(|| self.survivors.iter().map(duel).collect());
        }
    }

    fn fight(&mut self) {
        for (&champion, duels) in &mut self.duels {
            for (duel, &challenger) in duels.iter_mut().zip(&self.survivors) {
                if challenger != champion {
                    duel.advance(self.samples.of(champion), self.samples.of(challenger));
                }
            }
        }
    }

    /// Puts out all against whom there is enough evidence, the most beaten first and of equals the
    /// worst by mean, but never the last one.
    fn eliminate(&mut self) {
        let mut beaten: Vec<(f64, usize)> = (0..self.survivors.len())
            .map(|place| (self.evidence(place), self.survivors[place]))
            .filter(|(evidence, _)| *evidence >= self.problem.threshold())
            .collect();
        beaten.sort_by(|(more, a), (less, b)| {
            let by_mean = self.samples.mean(*a).total_cmp(&self.samples.mean(*b));
            less.total_cmp(more).then(by_mean).then(b.cmp(a))
        });
        beaten.truncate(self.survivors.len() - 1);
        for (_, challenger) in beaten {
            self.put_out(challenger);
        }
    }

    /// The evidence of all champions against the survivor in a place.
    fn evidence(&self, place: usize) -> f64 {
        let challenger = self.survivors[place];
        let rivals = self.duels.iter().filter(|(rival, _)| **rival != challenger);
        let against: f64 = rivals.map(|(_, duels)| duels[place].evidence()).sum();
        self.bequeathed[challenger] + against
    }

    fn put_out(&mut self, beaten: usize) {
        let place = self
            .survivors
            .partition_point(|survivor| *survivor < beaten);
        self.eliminations.push(Elimination {
            configuration: beaten,
            by: self.strongest_rival(place),
            runs: self.samples.runs(beaten) as u64,
        });
        self.survivors.remove(place);
        for duels in self.duels.values_mut() {
            duels.remove(place);
        }
        if let Some(duels) = self.duels.remove(&beaten) {
            for (duel, &challenger) in duels.iter().zip(&self.survivors) {
                self.bequeathed[challenger] += duel.evidence();
            }
        }
    }

    /// Of the champions still in, the one with the most evidence against the survivor in a place;
    /// of equals, the best by mean.
    fn strongest_rival(&self, place: usize) -> usize {
        let champions: Vec<usize> = self.duels.keys().copied().collect();
        let mut rivals = self.samples.by_mean(&champions);
        rivals.retain(|rival| *rival != self.survivors[place]);
        let evidence = |rival: &usize| self.duels[rival][place].evidence();
        rivals
            .into_iter()
            .rev()
            .max_by(|a, b| evidence(a).total_cmp(&evidence(b)))
            .unwrap_or_else(|| self.best())
    }
}

impl Procedure for Race {
    fn next(&self) -> Option<Request> {
        let runs = self.samples.runs(*self.survivors.first()?);
        (self.survivors.len() > 1 || runs == 0).then(|| Request {
            configurations: self.survivors.clone(),
            first_run: runs as u64,
            runs: next_look(runs) - runs,
        })
    }

    fn tell(&mut self, merits: &[f64]) {
        self.run(merits);
    }

    fn best(&self) -> usize {
        self.samples
            .by_mean(&self.survivors)
            .first()
            .copied()
            .unwrap_or_default()
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
