//! The metric engine as studies see it.

use crate::judge::Outcome;
use crate::run::State;
use crate::scenario::{Scenario, ScenarioSpec};
use crate::step::tick::StepScratch;
use crate::warnings;
use base::document::{Document, Value};
use base::engine::{BlockOptions, Column, ColumnKind, Runner};
use base::engine::{Configuration, Engine, MeritTerm, NamedMerit};
use base::error::InputErrors;
use base::warning::Warning;
use std::borrow::Cow;
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

    fn files(&self, document: &Document) -> Vec<String> {
        ScenarioSpec::files(document)
    }

    fn merit_terms(&self, _: &Document) -> Vec<MeritTerm> {
        let false_alarms = MeritTerm {
            usual_max: Some(100.0),
            ..MeritTerm::new("false_alarms", "false_alarms")
        };
        let bounded = [
            ("time", "time_s"),
            ("robots", "robots"),
            ("failed", "failed"),
            ("price", "price"),
            ("found", "found"),
            ("missed", "missed"),
            ("collisions", "collisions"),
            ("energy", "energy_j"),
            ("distance", "distance_m"),
            ("stopped", "robots_stopped"),
        ];
        let bounded = bounded.map(|(name, column)| MeritTerm::new(name, column));
        bounded.into_iter().chain([false_alarms]).collect()
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
        let scenario = &*self.0;
        let most = scenario.bounds();
        let fixed = |name, kind, value| column(name, kind, value, Some(value));
        let mut columns = vec![
            up_to("time_s", ColumnKind::Real, scenario.time_limit_s),
            up_to("failed", ColumnKind::Flag, 1.0),
            fixed("robots", ColumnKind::Whole, most.robots),
            fixed("price", ColumnKind::Real, most.price),
            up_to("found", ColumnKind::Whole, most.targets),
            up_to("missed", ColumnKind::Whole, most.targets),
            column("false_alarms", ColumnKind::Whole, 0.0, None),
            up_to("collisions", ColumnKind::Whole, most.collisions),
            up_to("energy_j", ColumnKind::Real, most.energy_j),
            up_to("distance_m", ColumnKind::Real, most.distance_m),
            up_to("robots_stopped", ColumnKind::Whole, most.robots),
        ];
        for kind in &scenario.items {
            let count = f64::from(kind.count);
            columns.push(up_to(
                format!("found_{}", kind.name),
                ColumnKind::Whole,
                count,
            ));
            columns.push(up_to(
                format!("missed_{}", kind.name),
                ColumnKind::Whole,
                count,
            ));
        }
        columns
    }

    fn run_block(&self, seed: u64, runs: Range<u64>, options: BlockOptions) -> Vec<Vec<f64>> {
        let mut columns = vec![Vec::new(); self.columns().len()];
        let mut scratch = StepScratch::new(&self.0, options.may_share);
        for run in runs.take_while(|_| !options.is_stopped()) {
            let state = State::new(&self.0, seed, run).ok();
            let outcome = state.map(|state| self.finish(&mut scratch, state, options));
            let values = outcome.and_then(|outcome| self.values(&outcome));
            for (number, column) in columns.iter_mut().enumerate() {
                column.push(values.as_ref().map_or(f64::NAN, |values| values[number]));
            }
        }
        columns
    }
}

impl Runs {
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

    /// The outcome of a run, in the order of the columns; `None` if a value is not finite, so that
    /// the run is quarantined.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
    pub fn values(&self, outcome: &Outcome) -> Option<Vec<f64>> {
        if !outcome.is_finite() {
            return None;
        }
        let scenario = &*self.0;
        let target = |counts: &[u32]| {
            let kinds = scenario.items.iter().zip(counts);
            let target = kinds.filter(|(kind, _)| kind.is_target);
            f64::from(target.map(|(_, count)| count).sum::<u32>())
        };
        let most = scenario.bounds();
        let mut values = vec![
            outcome.time_s,
            f64::from(u8::from(outcome.has_failed)),
            most.robots,
            most.price,
            target(&outcome.found),
            target(&outcome.missed),
            outcome.false_alarms as f64,
            outcome.collisions as f64,
            outcome.energy_j,
            outcome.distance_m,
            f64::from(outcome.robots_stopped),
        ];
        let kinds = outcome.found.iter().zip(&outcome.missed);
        values.extend(kinds.flat_map(|(found, missed)| [f64::from(*found), f64::from(*missed)]));
        Some(values)
    }
}

fn up_to(name: impl Into<Cow<'static, str>>, kind: ColumnKind, most: f64) -> Column {
    column(name, kind, 0.0, Some(most))
}

fn column(
    name: impl Into<Cow<'static, str>>,
    kind: ColumnKind,
    min: f64,
    max: Option<f64>,
) -> Column {
    Column {
        name: name.into(),
        kind,
        min: Some(min),
        max,
    }
}
