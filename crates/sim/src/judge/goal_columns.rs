//! The outcome columns of scenarios with goals.

use super::goal_outcome::GoalOutcome;
use super::outcome::Outcome;
use crate::scenario::Scenario;
use base::engine::ColumnKind::{Real, Whole};
use base::engine::{Bounds, OutcomeColumn};

pub(super) type Column = OutcomeColumn<Scenario, Outcome>;

/// Columns of the counts of goals, of the times of those that were served, and of messages.
pub(super) fn columns() -> Vec<Column> {
    [counts(), times(), messages()]
        .into_iter()
        .flatten()
        .collect()
}

fn counts() -> Vec<Column> {
    let up_to_all = |on: &Scenario| Bounds::up_to(on.number_of_goals().into());
    vec![
        Column::new(
            "goals",
            Whole,
            |on| Bounds::fixed(on.number_of_goals().into()),
            |on, _| on.number_of_goals().into(),
        ),
        Column::new("served", Whole, up_to_all, of(|goals| goals.served.into()))
            .with_term("served", 11),
        Column::new(
            "served_twice",
            Whole,
            up_to_all,
            of(|goals| goals.served_twice.into()),
        )
        .with_term("served_twice", 12),
        Column::new(
            "expired",
            Whole,
            up_to_all,
            of(|goals| goals.expired.into()),
        )
        .with_term("expired", 13),
        Column::new(
            "issued",
            Whole,
            up_to_all,
            of(|goals| goals.balance.issued().into()),
        ),
        Column::new(
            "open",
            Whole,
            up_to_all,
            of(|goals| goals.balance.open.into()),
        ),
        Column::new(
            "reported",
            Whole,
            up_to_all,
            of(|goals| goals.balance.reported.into()),
        ),
        Column::new(
            "unknown",
            Whole,
            up_to_all,
            of(|goals| goals.balance.unknown.into()),
        ),
        Column::new(
            "done_in_error",
            Whole,
            up_to_all,
            of(|goals| goals.done_in_error.into()),
        ),
    ]
}

fn times() -> Vec<Column> {
    let time = |name, value: fn(&GoalOutcome) -> f64, place| {
        let term = name;
        Column::new(
            format!("{name}_s"),
            Real,
            |on: &Scenario| Bounds::up_to(on.longest_s()),
            of(value),
        )
        .with_term(term, place)
    };
    vec![
        time("waiting", |goals| goals.waiting_s, 14),
        time("travel", |goals| goals.travel_s, 15),
        time("blocked", |goals| goals.blocked_s, 16),
        time("service", |goals| goals.service_s, 17),
    ]
}

#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn messages() -> Vec<Column> {
    vec![
        Column::new(
            "messages_sent",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            of(|goals| goals.messages_sent as f64),
        )
        .with_capped_term("messages_sent", 18, 1e6),
        Column::new(
            "messages_dropped",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            of(|goals| goals.messages_dropped as f64),
        )
        .with_capped_term("messages_dropped", 19, 1e6),
        Column::new(
            "goals_refused",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            of(|goals| goals.goals_refused.into()),
        )
        .with_capped_term("goals_refused", 20, 100.0),
        Column::new(
            "leases_lapsed",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            of(|goals| goals.leases_lapsed.into()),
        )
        .with_capped_term("leases_lapsed", 21, 1000.0),
    ]
}

/// The value of a column, from the outcome of the goals.
fn of(value: fn(&GoalOutcome) -> f64) -> impl Fn(&Scenario, &Outcome) -> f64 {
    move |_, outcome| outcome.goals.as_ref().map_or(0.0, value)
}
