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

use crate::interim_analyses::next_analysis;
use crate::procedure::{Elimination, Exclude, Procedure, Request};
use crate::proportion_test::ProportionTest;

/// Runs of a configuration per run of the next dearer one, until it is decided.
const RUNS_PER_DEARER_RUN: usize = 8;

/// A requirement, and the cost of each configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct RequirementProblem {
    /// Of each configuration, at least one; finite.
    pub costs: Vec<f64>,
    /// The share of runs that must meet the requirement: above 0, below 1.
    pub probability: f64,
    /// Above 0, at most 1 - `probability`.
    pub tolerance: f64,
    /// The probability that the statement holds: above 0, below 1.
    pub confidence: f64,
}

/// What is known of a configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    /// Neither of the others yet.
    Open,
    /// It meets the requirement.
    Certified,
    /// It does not meet it with tolerance to spare.
    Refuted,
    /// It cannot be run.
    Excluded,
}

/// The procedure, between two of its rounds.
#[derive(Debug, Clone)]
pub struct Requirement {
    costs: Vec<f64>,
    /// Configurations by cost; of equals, the first one first.
    order: Vec<usize>,
    certify: ProportionTest,
    /// Evidence that certifies, as a logarithm.
    certified_at: f64,
    /// By exchanging successes and failures, a test against a high probability.
    refute: ProportionTest,
    refuted_at: f64,
    /// By configuration, the number of runs that met the requirement, and of those that did not.
    met: Vec<u64>,
    missed: Vec<u64>,
    statuses: Vec<Status>,
    eliminations: Vec<Elimination>,
}

impl Requirement {
    /// A procedure without any runs.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "configurations are far fewer than 2^53"
    )]
    pub fn new(problem: RequirementProblem) -> Self {
        let count = problem.costs.len();
        let spare = problem.probability + problem.tolerance;
        let half_error = (1.0 - problem.confidence) / 2.0;
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| problem.costs[*a].total_cmp(&problem.costs[*b]));
        Self {
            costs: problem.costs,
            order,
            certify: ProportionTest::new(problem.probability, spare.min(1.0)),
            certified_at: libm::log(count as f64 / half_error),
            refute: ProportionTest::new((1.0 - spare).max(0.0), 1.0 - problem.probability),
            refuted_at: libm::log(1.0 / half_error),
            met: vec![0; count],
            missed: vec![0; count],
            statuses: vec![Status::Open; count],
            eliminations: Vec::new(),
        }
    }

    fn runs_of(&self, configuration: usize) -> usize {
        usize::try_from(self.met[configuration] + self.missed[configuration]).unwrap_or(usize::MAX)
    }

    /// Open configurations that are cheaper than every certified one, the cheapest first.
    fn candidates(&self) -> impl Iterator<Item = usize> {
        let max = self
            .selected()
            .map_or(f64::INFINITY, |each| self.costs[each]);
        let order = self.order.iter().copied();
        let cheaper = order.take_while(move |each| self.costs[*each] < max);
        cheaper.filter(|each| self.statuses[*each] == Status::Open)
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
        let (met, missed) = (
            &mut self.met[configuration],
            &mut self.missed[configuration],
        );
        *(if is_met { &mut *met } else { &mut *missed }) += 1;
        let (met, missed) = (*met, *missed);
        if self.statuses[configuration] != Status::Open {
            return;
        }
        if self.certify.reaches(self.certified_at, met, missed) {
            self.statuses[configuration] = Status::Certified;
        } else if self.refute.reaches(self.refuted_at, missed, met) {
            self.statuses[configuration] = Status::Refuted;
            self.eliminations.push(Elimination {
                configuration,
                by: None,
                runs: met + missed,
            });
        }
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
        let mut order = self.order.iter().copied();
        order.find(|each| self.statuses[*each] == Status::Certified)
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
        let certified = |each: &usize| self.statuses[*each] == Status::Certified;
        (0..self.statuses.len()).filter(certified).collect()
    }

    fn eliminations(&self) -> Vec<Elimination> {
        self.eliminations.clone()
    }
}

impl Exclude for Requirement {
    fn exclude(&mut self, configurations: &[usize]) {
        for each in configurations {
            self.statuses[*each] = Status::Excluded;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(costs: &[f64]) -> RequirementProblem {
        RequirementProblem {
            costs: costs.to_vec(),
            probability: 0.9,
            tolerance: 0.05,
            confidence: 0.95,
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "few")]
    fn count(runs: u64, share: f64) -> f64 {
        (runs as f64 * share).floor()
    }

    /// Runs a procedure in which the share of runs that meet the requirement is exactly the given one.
    fn ended(problem: RequirementProblem, shares: &[f64]) -> Requirement {
        let mut procedure = Requirement::new(problem);
        while let Some(request) = procedure.next() {
            let share = shares[request.configurations[0]];
            let runs = request.first_run..request.first_run + request.runs as u64;
            let met = runs.map(|run| count(run + 1, share) - count(run, share));
            procedure.record(&met.collect::<Vec<f64>>());
        }
        procedure
    }

    #[test]
    fn the_cheapest_that_meets_it_is_selected_whatever_the_order() {
        let shares = [1.0, 0.2, 0.99, 0.5];
        assert_eq!(
            ended(problem(&[4.0, 1.0, 3.0, 2.0]), &shares).selected(),
            Some(2)
        );
        assert_eq!(
            ended(problem(&[1.0, 2.0, 3.0, 4.0]), &shares).selected(),
            Some(0)
        );
    }

    #[test]
    fn nothing_is_selected_if_none_meets_it() {
        let procedure = ended(problem(&[1.0, 2.0]), &[0.5, 0.8]);
        assert_eq!(procedure.selected(), None);
        assert_eq!(procedure.eliminations().len(), 2);
        assert!(procedure.survivors().is_empty() && procedure.certified().is_empty());
    }

    #[test]
    fn those_that_are_dearer_than_a_certified_one_are_not_run() {
        let procedure = ended(problem(&[1.0, 2.0, 3.0, 3.0]), &[0.3, 1.0, 1.0, 1.0]);
        assert_eq!(procedure.selected(), Some(1));
        assert_eq!(procedure.runs()[2..], [0, 0]);
        assert_eq!(procedure.survivors(), [1]);
    }

    #[test]
    fn of_equal_costs_one_is_enough() {
        let procedure = ended(problem(&[1.0, 1.0]), &[1.0, 1.0]);
        assert_eq!((procedure.certified(), procedure.runs()[1]), (vec![0], 0));
        assert_eq!(procedure.next(), None);
    }

    #[test]
    fn a_hard_configuration_does_not_keep_a_dearer_one_from_being_certified() {
        let mut procedure = Requirement::new(problem(&[1.0, 2.0]));
        let mut runs = 0;
        while procedure.selected().is_none() {
            let request = procedure.next().expect("the first is never decided");
            runs += request.runs;
            assert!(runs < 5000);
            // Exactly between the limits, so that neither test gets far.
            let is_first = request.configurations == [0];
            let is_met = |run: u64| !is_first || !run.is_multiple_of(13);
            let runs = request.first_run..request.first_run + request.runs as u64;
            let met: Vec<f64> = runs.map(|run| f64::from(u8::from(is_met(run)))).collect();
            procedure.record(&met);
        }
        assert_eq!(procedure.selected(), Some(1));
        assert_eq!(procedure.survivors(), [0, 1]);
    }
}
