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
    /// Of each champion, its duels with all configurations.
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
            samples: Samples::new(configurations),
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
            let bounds = &self.problem.bounds;
            self.duels.entry(champion).or_insert_with(|| {
                let duel = |other| Duel::new(bounds[champion], other, self.problem.delta);
                bounds.iter().copied().map(duel).collect()
            });
        }
    }

    fn fight(&mut self) {
        for (&champion, duels) in &mut self.duels {
            for &challenger in self.survivors.iter().filter(|other| **other != champion) {
                let (champion, other) = (self.samples.of(champion), self.samples.of(challenger));
                duels[challenger].advance(champion, other);
            }
        }
    }

    /// Puts out all against whom there is enough evidence, the most beaten first, but never the
    /// last one.
    fn eliminate(&mut self) {
        let mut beaten: Vec<(f64, usize)> = self
            .survivors
            .iter()
            .map(|challenger| (self.evidence(*challenger), *challenger))
            .filter(|(evidence, _)| *evidence >= self.problem.threshold())
            .collect();
        beaten.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        beaten.truncate(self.survivors.len() - 1);
        for (_, challenger) in beaten {
            self.put_out(challenger);
        }
    }

    fn evidence(&self, challenger: usize) -> f64 {
        let against = |(champion, duels): (&usize, &Vec<Duel>)| {
            if *champion == challenger {
                0.0
            } else {
                duels[challenger].evidence()
            }
        };
        self.bequeathed[challenger] + self.duels.iter().map(against).sum::<f64>()
    }

    fn put_out(&mut self, beaten: usize) {
        self.eliminations.push(Elimination {
            configuration: beaten,
            by: self.strongest_rival(beaten),
            runs: self.samples.runs(beaten) as u64,
        });
        self.survivors.retain(|survivor| *survivor != beaten);
        if let Some(duels) = self.duels.remove(&beaten) {
            for &challenger in &self.survivors {
                self.bequeathed[challenger] += duels[challenger].evidence();
            }
        }
    }

    /// The champion with the most evidence against a configuration; of equals, the best by mean.
    fn strongest_rival(&self, beaten: usize) -> usize {
        let champions: Vec<usize> = self.duels.keys().copied().collect();
        let mut rivals = self.samples.by_mean(&champions);
        rivals.retain(|rival| *rival != beaten);
        let evidence = |rival: &usize| self.duels[rival][beaten].evidence();
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
