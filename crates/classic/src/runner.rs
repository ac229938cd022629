//! Configurations of the classic engine, as studies run them.

use crate::clock::{Clock, DECISION_PERIOD, FIRST_DECISION};
use crate::fast::FastSearch;
use crate::search::{Outcome, Task};
use crate::start::random_cell;
use crate::world::ITEMS;
use base::engine::ColumnKind::{Flag, Real, Whole};
use base::engine::{BlockOptions, Bounds, Column, OutcomeColumn, OutcomeColumns, Runner};
use std::ops::Range;

/// A typical `max` for paints: the 120 s of the experiment.
const USUAL_PAINTS: f64 = 6720.0;

/// Everything that a run depends on, apart from its seed and its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Configuration {
    /// Team size.
    pub robots: u32,
    /// What counts as a find, and the time limit.
    pub task: Task,
    /// Conversion of paints to seconds.
    pub clock: Clock,
}

/// The outcome columns, each defined in one place.
pub(crate) fn columns() -> OutcomeColumns<Configuration, Outcome> {
    type Column = OutcomeColumn<Configuration, Outcome>;
    OutcomeColumns(vec![
        Column::new(
            "time_s",
            Real,
            |on| Bounds::up_to(on.clock.time_limit_s),
            time_s,
        )
        .with_term("time", 0),
        Column::new(
            "failed",
            Flag,
            |_| Bounds::up_to(1.0),
            |on, of| u8::from(on.in_time(of).is_none()).into(),
        )
        .with_term("failed", 2),
        Column::new(
            "robots",
            Whole,
            |on| Bounds::fixed(on.robots.into()),
            |on, _| on.robots.into(),
        )
        .with_term("robots", 1),
        Column::new(
            "found",
            Whole,
            |_| Bounds::up_to(whole(ITEMS.len() as u64)),
            |_, of| of.found.into(),
        )
        .with_term("found", 3),
        Column::new(
            "collisions",
            Whole,
            |on| Bounds::up_to(whole(on.max_collisions())),
            |_, of| whole(of.collisions),
        )
        .with_term("collisions", 4),
        Column::new(
            "paints",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            |_, of| of.paints.map_or(f64::INFINITY, whole),
        )
        .with_capped_term("paints", 5, USUAL_PAINTS),
    ])
}

/// Time until the last item was found; the time limit if it was not.
fn time_s(configuration: &Configuration, outcome: &Outcome) -> f64 {
    let Clock {
        paints_per_s,
        time_limit_s,
        ..
    } = configuration.clock;
    let in_time = configuration.in_time(outcome);
    // The last paint within the time limit may exceed it by a rounding error: see `whole_paints`.
    in_time.map_or(time_limit_s, |at| {
        (whole(at) / paints_per_s).min(time_limit_s)
    })
}

#[expect(
    clippy::cast_precision_loss,
    reason = "collisions are bounded; paints beyond 2^53 take years to compute"
)]
fn whole(number: u64) -> f64 {
    number as f64
}

impl Runner for Configuration {
    fn columns(&self) -> Vec<Column> {
        columns().of(self)
    }

    fn run_block(&self, seed: u64, runs: Range<u64>, options: BlockOptions) -> Vec<Vec<f64>> {
        let mut search = FastSearch::new(self.task);
        let runs = runs.take_while(|_| !options.is_stopped());
        let team = |run| (0..self.robots).map(move |index| random_cell(seed, run, index));
        let outcomes = runs.map(|run| Some(search.run(team(run))));
        columns().table(self, outcomes)
    }
}

impl Configuration {
    /// The values of an outcome, in the order of the columns.
    pub(crate) fn values(&self, outcome: Outcome) -> Vec<f64> {
        columns().values(self, &outcome)
    }

    /// The paint at which the last item was found, if that is within the time limit.
    fn in_time(&self, outcome: &Outcome) -> Option<u64> {
        let limit = self.task.time_limit_paints;
        outcome.paints.filter(|at| *at <= limit)
    }

    fn max_collisions(&self) -> u64 {
        u64::from(self.robots) * decisions_until(self.task.time_limit_paints)
    }
}

/// Number of decisions of a team up to and including a paint.
fn decisions_until(paint: u64) -> u64 {
    paint
        .checked_sub(FIRST_DECISION)
        .map_or(0, |since| since / DECISION_PERIOD + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Contact;
    use crate::search::search;
    use crate::start::random_team;

    fn configuration(robots: u32, contact: Contact, time_limit_paints: u64) -> Configuration {
        Configuration {
            robots,
            task: Task {
                contact,
                time_limit_paints,
            },
            clock: Clock {
                paints_per_s: 50.0,
                time_limit_s: f64::from(u32::try_from(time_limit_paints).unwrap()) / 50.0,
                time_limit_paints,
            },
        }
    }

    #[test]
    fn a_block_is_what_the_plain_form_gives_for_that_team_seed_and_run_numbers() {
        for (robots, contact) in [
            (1, Contact::Ahead),
            (3, Contact::Touch),
            (40, Contact::Within2),
        ] {
            let configuration = configuration(robots, contact, 2000);
            let start = |run| random_team(robots, 7, run);
            let expected = (5..205).map(|run| search(&start(run), configuration.task));
            let block = configuration.run_block(7, 5..205, BlockOptions::ALONE);
            for (index, outcome) in expected.enumerate() {
                let row: Vec<f64> = block.iter().map(|column| column[index]).collect();
                assert_eq!(row, configuration.values(outcome));
            }
        }
    }

    #[test]
    fn every_run_is_within_the_columns_bounds() {
        for (robots, time_limit_paints) in
            [(1, 0), (2, 11), (5, 12), (100, 23), (250, 300), (3, 6720)]
        {
            let configuration = configuration(robots, Contact::Touch, time_limit_paints);
            let block = configuration.run_block(1, 0..200, BlockOptions::ALONE);
            for (column, values) in configuration.columns().iter().zip(block) {
                let min = column.bounds.min.unwrap_or(f64::NEG_INFINITY);
                let max = column.bounds.max.unwrap_or(f64::INFINITY);
                let is_within = |value: &f64| (min..=max).contains(value);
                assert!(values.iter().all(is_within), "{}", column.name);
                let is_whole = |value: &f64| value.is_infinite() || value.fract() == 0.0;
                assert!(column.kind == Real || values.iter().all(is_whole));
            }
        }
    }

    #[test]
    fn a_search_that_never_ends_has_failed_at_the_time_limit_after_infinite_paints() {
        let outcome = Outcome {
            paints: None,
            found: 3,
            collisions: 8,
        };
        let never = configuration(2, Contact::Touch, 6000).values(outcome);
        assert_eq!(never, [120.0, 1.0, 2.0, 3.0, 8.0, f64::INFINITY]);
    }

    #[test]
    fn a_search_that_ends_beyond_the_time_limit_has_failed_and_its_paints_are_reported() {
        let outcome = Outcome {
            paints: Some(6001),
            found: 3,
            collisions: 8,
        };
        let late = configuration(2, Contact::Touch, 6000).values(outcome);
        assert_eq!(late, [120.0, 1.0, 2.0, 3.0, 8.0, 6001.0]);
    }

    #[test]
    fn a_time_is_never_beyond_a_limit_that_floats_cannot_hold() {
        let mut rounded = configuration(1, Contact::Touch, 435);
        rounded.clock.paints_per_s = 100.0;
        rounded.clock.time_limit_s = 4.35 - 1e-9;
        let last = Outcome {
            paints: Some(435),
            found: 4,
            collisions: 0,
        };
        assert_eq!(rounded.values(last)[..2], [4.35 - 1e-9, 0.0]);
    }

    #[test]
    fn merit_terms_are_summed_in_the_order_of_stored_studies() {
        let terms = columns().merit_terms();
        let names: Vec<&str> = terms.iter().map(|term| &*term.name).collect();
        assert_eq!(
            names.join(" "),
            "time robots failed found collisions paints"
        );
    }

    #[test]
    fn decisions_are_counted_to_the_paint_of_the_last() {
        let counted = [0, 11, 12, 22, 23, 6720].map(decisions_until);
        assert_eq!(counted, [0, 0, 1, 1, 2, 610]);
    }
}
