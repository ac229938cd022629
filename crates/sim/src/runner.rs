//! The metric engine as studies see it.

use crate::derived;
use crate::judge::{Outcome, columns};
use crate::run::State;
use crate::scenario::{Scenario, ScenarioSpec};
use crate::step::tick::StepScratch;
use crate::warnings;
use base::document::{Document, Value};
use base::engine::{BlockOptions, Column, OutcomeColumns, Runner};
use base::engine::{Configuration, Engine, MeritTerm, NamedMerit};
use base::error::InputErrors;
use base::scenario::condition::ConditionColumns;
use base::warning::Warning;
use std::ops::Range;
use std::sync::Arc;

/// The metric engine, as scenarios name it.
#[derive(Debug, Clone, Copy)]
pub struct Metric;

/// Runs of a scenario.
#[derive(Debug, Clone)]
pub struct Runs(pub Arc<Scenario>);

impl Engine for Metric {
    fn name(&self) -> &'static str {
        "metric"
    }

    fn keys(&self) -> &'static [&'static str] {
        &ScenarioSpec::KEYS
    }

    fn read(&self, document: &Document) -> Result<Configuration, InputErrors> {
        let scenario = ScenarioSpec::read(document)?.scenario;
        Ok(Configuration {
            robots: scenario.team(),
            time_limit_s: scenario.time_limit_s,
            facts: scenario.facts(),
            runner: Box::new(Runs(Arc::new(scenario))),
        })
    }

    fn warnings(
        &self,
        document: &Document,
        configurations: &[Vec<(String, Value)>],
    ) -> Vec<Warning> {
        warnings::warnings(document, configurations)
    }

    fn derived(&self, document: &Document) -> Vec<(String, String)> {
        let read = ScenarioSpec::read(document);
        read.map_or_else(
            |_| Vec::new(),
            |checked| {
                let mut derived = derived::derived(&checked);
                derived.extend(checked.scenario.recoveries());
                derived
            },
        )
    }

    fn files(&self, document: &Document) -> Vec<String> {
        ScenarioSpec::files(document)
    }

    fn merit_terms(&self, document: &Document) -> Vec<MeritTerm> {
        columns::columns(&[], [&[], &[]], ScenarioSpec::features(document)).merit_terms()
    }

    fn condition_columns(&self, document: &Document) -> ConditionColumns {
        columns::condition_columns(document)
    }

    fn merits(&self) -> &'static [NamedMerit] {
        &[NamedMerit::EQUATION_5_2]
    }

    fn factors(&self) -> Option<&'static [&'static str]> {
        None
    }

    fn names(&self, document: &Document, path: &[&str]) -> Option<Vec<String>> {
        ScenarioSpec::names(document, path)
    }

    fn max_robots(&self) -> u32 {
        1_000_000
    }
}

impl Runner for Runs {
    fn columns(&self) -> Vec<Column> {
        self.outcome_columns().of(&self.0)
    }

    fn run_block(&self, seed: u64, runs: Range<u64>, options: BlockOptions) -> Vec<Vec<f64>> {
        let mut scratch = StepScratch::new(&self.0, options.may_share);
        let runs = runs.take_while(|_| !options.is_stopped());
        let outcomes = runs.map(|run| {
            let state = State::new(&self.0, seed, run).ok()?;
            let outcome = self.finish(&mut scratch, state, options);
            outcome.is_finite().then_some(outcome)
        });
        self.outcome_columns().table(&self.0, outcomes)
    }
}

impl Runs {
    fn outcome_columns(&self) -> OutcomeColumns<Scenario, Outcome> {
        let robots = self.0.kinds.iter().map(|kind| kind.name.as_str());
        let robots: Vec<&str> = robots.collect();
        let names = [robots.as_slice(), &self.0.mines()];
        columns::columns(&self.0.max_item_counts(), names, self.0.features())
    }

    fn finish(
        &self,
        scratch: &mut StepScratch,
        mut state: State,
        options: BlockOptions,
    ) -> Outcome {
        let scenario = &*self.0;
        scratch.invalidate();
        while !state.is_over(scenario) && !options.is_stopped() {
            scratch.step(scenario, &mut state);
        }
        state.outcome(scenario)
    }

    /// The outcome of a run, in the order of the columns; `None` if the run is quarantined. The times of finds that
    /// did not happen are +infinity.
    #[must_use]
    pub fn values(&self, outcome: &Outcome) -> Option<Vec<f64>> {
        let is_finite = outcome.is_finite();
        is_finite.then(|| self.outcome_columns().values(&self.0, outcome))
    }
}
