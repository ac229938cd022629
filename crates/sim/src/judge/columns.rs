//! The outcome columns, each defined in one place.

use super::outcome::Outcome;
use crate::scenario::Scenario;
use base::engine::ColumnKind::{Flag, Real, Whole};
use base::engine::{Bounds, OutcomeColumn, OutcomeColumns};

type Column = OutcomeColumn<Scenario, Outcome>;

/// The outcome columns of scenarios with kinds of items of these names.
pub(crate) fn columns<'n>(
    items: impl IntoIterator<Item = &'n str>,
) -> OutcomeColumns<Scenario, Outcome> {
    let per_kind = items.into_iter().enumerate().flat_map(of_items);
    let columns = [time_and_team(), finds(), costs()].into_iter().flatten();
    OutcomeColumns(columns.chain(per_kind).collect())
}

fn time_and_team() -> Vec<Column> {
    vec![
        Column::new(
            "time_s",
            Real,
            |on| Bounds::up_to(on.time_limit_s),
            |_, of| of.time_s,
        )
        .with_term("time", 0),
        Column::new(
            "failed",
            Flag,
            |_| Bounds::up_to(1.0),
            |_, of| u8::from(of.has_failed).into(),
        )
        .with_term("failed", 2),
        Column::new(
            "robots",
            Whole,
            |on| Bounds::fixed(on.team_size()),
            |on, _| on.team_size(),
        )
        .with_term("robots", 1),
        Column::new(
            "price",
            Real,
            |on| Bounds::fixed(on.price()),
            |on, _| on.price(),
        )
        .with_term("price", 3),
    ]
}

fn finds() -> Vec<Column> {
    vec![
        Column::new(
            "found",
            Whole,
            |on| Bounds::up_to(on.targets().into()),
            |on, of| targets(on, &of.found),
        )
        .with_term("found", 4),
        Column::new(
            "missed",
            Whole,
            |on| Bounds::up_to(on.targets().into()),
            |on, of| targets(on, &of.missed),
        )
        .with_term("missed", 5),
        Column::new(
            "false_alarms",
            Whole,
            |_| Bounds::NOT_NEGATIVE,
            |_, of| count(of.false_alarms),
        )
        .with_capped_term("false_alarms", 10, 100.0),
    ]
}

fn costs() -> Vec<Column> {
    vec![
        Column::new(
            "collisions",
            Whole,
            |on| Bounds::up_to(on.max_collisions()),
            |_, of| count(of.collisions),
        )
        .with_term("collisions", 6),
        Column::new(
            "energy_j",
            Real,
            |on| Bounds::up_to(on.max_energy_j()),
            |_, of| of.energy_j,
        )
        .with_term("energy", 7),
        Column::new(
            "distance_m",
            Real,
            |on| Bounds::up_to(on.max_distance_m()),
            |_, of| of.distance_m,
        )
        .with_term("distance", 8),
        Column::new(
            "robots_stopped",
            Whole,
            |on| Bounds::up_to(on.team_size()),
            |_, of| of.robots_stopped.into(),
        )
        .with_term("stopped", 9),
    ]
}

/// The columns of one kind of items, by its number.
fn of_items((number, kind): (usize, &str)) -> [Column; 2] {
    let of_all = move |on: &Scenario| Bounds::up_to(on.items[number].count.into());
    let found = move |_: &Scenario, of: &Outcome| of.found[number].into();
    let missed = move |_: &Scenario, of: &Outcome| of.missed[number].into();
    [
        Column::new(format!("found_{kind}"), Whole, of_all, found),
        Column::new(format!("missed_{kind}"), Whole, of_all, missed),
    ]
}

#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn count(events: u64) -> f64 {
    events as f64
}

/// The sum of counts by kind of items, over the kinds that are targets.
fn targets(scenario: &Scenario, counts: &[u32]) -> f64 {
    let kinds = scenario.items.iter().zip(counts);
    let targets = kinds.filter(|(kind, _)| kind.is_target);
    targets.map(|(_, count)| count).sum::<u32>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merit_terms_are_summed_in_the_order_of_stored_studies() {
        let terms = columns([]).merit_terms();
        let names: Vec<&str> = terms.iter().map(|term| &*term.name).collect();
        let expected = "time robots failed price found missed collisions energy distance stopped \
                        false_alarms";
        assert_eq!(names.join(" "), expected);
    }
}
