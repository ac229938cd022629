//! The cheapest configuration that meets a requirement: a run either meets it or not, and in a
//! sufficient share of runs it must.
//!
//! With probability `confidence`, when the procedure ends by itself:
//!
//! * the selected configuration meets the requirement: the probability that a run does is at least
//!   `probability`;
//! * no strictly cheaper configuration meets it with tolerance to spare, that is, with at least
//!   `probability + tolerance`.
//!
//! Two tests (see `proportion_test`) run for each configuration. One *certifies* it: the claim that
//! its probability is below `probability` is refuted. The other *refutes* it: the claim that its
//! probability is at least `probability + tolerance` is. Whatever the probability, the evidence of at
//! least one of them tends to grow, so that every configuration is decided at last.
//!
//! The allowed error is divided into two halves:
//!
//! * *Certifying.* Any configuration may be certified wrongly, so each is certified at the half
//!   divided by their number.
//! * *Refuting* needs no correction. Consider the cheapest configuration that meets the requirement
//!   with tolerance to spare (of equals, the first). If the selected one is dearer, that one
//!   configuration was refuted, wrongly; the errors of all others do no harm.
//!
//! Configurations run cheapest first, because every configuration that is cheaper than the selected
//! one must be refuted in any case, and those that are dearer than a certified one need no runs. To
//! certify something soon, in case that the procedure is stopped, the next dearer configuration has
//! an eighth of the runs of the one before it.
//!
//! More expensive is never assumed to be better.
//!
//! A configuration whose probability is between `probability` and `probability + tolerance` may be
//! refuted. With a *finer* tolerance, a second question follows about those that are cheaper than the
//! selected one: until one of them is certified, or all are refuted at the finer tolerance. Its tests
//! have errors of their own, half as large; together with the certification by the first question,
//! both statements at the finer tolerance hold with `confidence` again. As long as it is open, those
//! of the first question hold.
//!
//! A third test shows that the probability of a configuration is *below* `probability` itself. With
//! `confidence`, as a statement of its own, the cheapest configuration that meets the requirement is not
//! among those of which it shows that: as in refuting, only the error of one configuration matters. The
//! finer question needs it where the share of runs is below `probability` by more than the tolerance.

mod stage;

use self::stage::{Limits, Stage, Status, Tests};
use crate::interim_analyses::next_analysis;
use crate::procedure::{Elimination, Exclude, Procedure, Request};

/// Runs of a configuration per run of the next dearer one, until it is decided.
const RUNS_PER_DEARER_RUN: usize = 8;

/// Maximum number of runs that is predicted.
const MAX_RUNS: u64 = 1_000_000_000;

/// A requirement, and the cost of each configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct RequirementProblem {
    /// Of each configuration, at least one; finite.
    pub costs: Vec<f64>,
    /// The share of runs that must meet the requirement: above 0, below 1.
    pub probability: f64,
    /// Above 0, at most 1 - `probability`.
    pub tolerance: f64,
    /// That of the second question, if there is one; above 0, below `tolerance`.
    pub finer: Option<f64>,
    /// The probability that the statement holds: above 0, below 1.
    pub confidence: f64,
}

/// The procedure, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Requirement {
    costs: Vec<f64>,
    /// Configurations by cost; of equals, the first one first.
    order: Vec<usize>,
    first: Stage,
    finer: Option<Stage>,
    /// By configuration, the number of runs that met the requirement, and of those that did not.
    met: Vec<u64>,
    missed: Vec<u64>,
    eliminations: Vec<Elimination>,
}

impl Requirement {
    /// A procedure without any runs.
    #[must_use]
    pub fn new(problem: RequirementProblem) -> Self {
        let count = problem.costs.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| problem.costs[*a].total_cmp(&problem.costs[*b]));
        let finer = problem.finer;
        Self {
            first: Stage::new(problem.limits()),
            finer: finer.map(|tolerance| Stage::new(problem.finer_limits(tolerance))),
            costs: problem.costs,
            order,
            met: vec![0; count],
            missed: vec![0; count],
            eliminations: Vec::new(),
        }
    }

    fn runs_of(&self, configuration: usize) -> usize {
        usize::try_from(self.met[configuration] + self.missed[configuration]).unwrap_or(usize::MAX)
    }

    /// The cheapest configuration that one of some stages has certified; of equals, the first.
    fn cheapest(&self, stages: &[&Stage]) -> Option<usize> {
        let is_certified = |each: &usize| {
            stages
                .iter()
                .any(|stage| stage.statuses[*each] == Status::Certified)
        };
        self.order.iter().copied().find(is_certified)
    }

    /// The configurations that a stage has still to decide, the cheapest first: its open ones that are
    /// cheaper than a selected one.
    fn open<'s>(
        &'s self,
        stage: &'s Stage,
        selected: Option<usize>,
    ) -> impl Iterator<Item = usize> + use<'s> {
        let max = selected.map_or(f64::INFINITY, |each| self.costs[each]);
        let order = self.order.iter().copied();
        let cheaper = order.take_while(move |each| self.costs[*each] < max);
        cheaper.filter(|each| stage.statuses[*each] == Status::Open)
    }

    /// The question that is open: the first one, then the finer one.
    fn stage(&self) -> &Stage {
        match &self.finer {
            Some(finer) if self.is_settled() => finer,
            _ => &self.first,
        }
    }

    /// The configurations that it has still to decide.
    fn candidates(&self) -> impl Iterator<Item = usize> {
        self.open(self.stage(), self.selected())
    }

    /// The configuration that runs next.
    fn candidate(&self) -> Option<usize> {
        let mut candidates = self.candidates();
        let mut chosen = candidates.next()?;
        for dearer in candidates {
            let next = next_analysis(self.runs_of(dearer));
            if next * RUNS_PER_DEARER_RUN > self.runs_of(chosen) {
                break;
            }
            chosen = dearer;
        }
        Some(chosen)
    }

    fn add(&mut self, configuration: usize, is_met: bool) {
        let counted = if is_met {
            &mut self.met
        } else {
            &mut self.missed
        };
        counted[configuration] += 1;
        let (met, missed) = (self.met[configuration], self.missed[configuration]);
        if let Some(finer) = &mut self.finer {
            finer.decide(configuration, met, missed);
        }
        if self.first.decide(configuration, met, missed) {
            self.eliminations.push(Elimination {
                configuration,
                by: None,
                runs: met + missed,
            });
        }
    }
}

impl RequirementProblem {
    fn limits(&self) -> Limits {
        Limits {
            probability: self.probability,
            tolerance: self.tolerance,
            error: (1.0 - self.confidence) / 2.0,
            below_error: 1.0 - self.confidence,
            count: self.costs.len(),
            needs_below: false,
        }
    }

    fn finer_limits(&self, tolerance: f64) -> Limits {
        Limits {
            tolerance,
            error: (1.0 - self.confidence) / 4.0,
            needs_below: true,
            ..self.limits()
        }
    }

    /// The number of runs, from `runs` on, after which the finer question decides a configuration if
    /// `share` of them meet the requirement; at most 10^9.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "runs are far fewer than 2^53, and a share of them is not negative"
    )]
    pub fn runs_to_decide(&self, share: f64, runs: u64) -> u64 {
        let tests = Tests::new(self.finer_limits(self.finer.unwrap_or(self.tolerance)));
        let is_open = |runs: u64| {
            let met = (runs as f64 * share).round() as u64;
            tests.status(met, runs - met) == Status::Open
        };
        let mut runs = runs.max(1);
        while runs < MAX_RUNS && is_open(runs) {
            runs += runs.div_ceil(50);
        }
        runs
    }
}

impl Procedure for Requirement {
    fn next(&self) -> Option<Request> {
        let configuration = self.candidate()?;
        let runs = self.runs_of(configuration);
        Some(Request {
            configurations: vec![configuration],
            first_run: runs as u64,
            runs: next_analysis(runs) - runs,
        })
    }

    /// Records 1 for each run that meets the requirement, and 0 for each that does not.
    fn record(&mut self, met: &[f64]) {
        if let Some(configuration) = self.candidate() {
            for met in met {
                self.add(configuration, *met > 0.5);
            }
        }
    }

    /// The cheapest certified configuration; of equals, the first.
    fn selected(&self) -> Option<usize> {
        match &self.finer {
            Some(finer) if self.is_settled() => self.cheapest(&[&self.first, finer]),
            _ => self.cheapest(&[&self.first]),
        }
    }

    fn runs(&self) -> Vec<u64> {
        let runs = self.met.iter().zip(&self.missed);
        runs.map(|(met, missed)| met + missed).collect()
    }

    /// Those that are neither refuted nor dearer than a certified one.
    fn survivors(&self) -> Vec<usize> {
        let mut survivors: Vec<usize> = self.candidates().chain(self.selected()).collect();
        survivors.sort_unstable();
        survivors
    }

    fn certified(&self) -> Vec<usize> {
        let finer = self.finer.as_ref().filter(|_| self.is_settled());
        let stages = core::iter::once(&self.first).chain(finer);
        let is_certified = |each: &usize| {
            stages
                .clone()
                .any(|stage| stage.statuses[*each] == Status::Certified)
        };
        (0..self.costs.len()).filter(is_certified).collect()
    }

    /// Those of the smallest tolerance.
    fn below(&self) -> Vec<usize> {
        let below = &self.finer.as_ref().unwrap_or(&self.first).below;
        (0..below.len()).filter(|each| below[*each]).collect()
    }

    fn is_settled(&self) -> bool {
        let selected = self.cheapest(&[&self.first]);
        self.open(&self.first, selected).next().is_none()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        self.eliminations.clone()
    }
}

impl Exclude for Requirement {
    fn exclude(&mut self, configurations: &[usize]) {
        for stage in core::iter::once(&mut self.first).chain(&mut self.finer) {
            for each in configurations {
                stage.statuses[*each] = Status::Excluded;
            }
        }
    }
}

#[cfg(test)]
mod tests;
