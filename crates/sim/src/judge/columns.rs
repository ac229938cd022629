//! The outcome columns, each defined in one place.

use super::act_columns;
use super::clearance_columns;
use super::find_times::{find_time, find_times};
use super::goal_columns::{self, Column};
use super::outcome::Outcome;
use super::passage_columns;
use super::unseen::unseen;
use crate::scenario::features::Features;
use crate::scenario::{Scenario, ScenarioSpec};
use base::document::Document;
use base::engine::ColumnKind::{Flag, Real, Whole};
use base::engine::{Bounds, OutcomeColumns};
use base::scenario::condition::{ConditionColumns, TimesUntil};

/// The outcome columns of scenarios with these kinds of robots and of items, each of these with the largest number of items in any
/// configuration of the study: all configurations have the same columns. With kinds of goals, there are those of goals;
/// where anything can happen to items besides detections, those of acts, and where controllers clear a lane, those of its
/// clearance, with its kinds of mines, and of vehicles that pass it.
pub(crate) fn columns(
    items: &[(&str, u32)],
    [robots, mines]: [&[&str]; 2],
    has: Features,
) -> OutcomeColumns<Scenario, Outcome> {
    let items = items.iter().copied().enumerate();
    let counts = items.clone().flat_map(counts_of);
    let times = items.flat_map(find_times_of);
    let columns = [time_and_team(), finds(), costs()].into_iter().flatten();
    let goals = has.goals.then(goal_columns::columns);
    let acts = has.acts.then(act_columns::columns);
    let clearance = has
        .clearance
        .then(|| clearance_columns::columns(robots, has));
    let cleared = has.clearance.then(|| passage_columns::of_mines(mines));
    let passage = has.passage.then(passage_columns::columns);
    let more = [goals, acts, clearance, cleared, passage]
        .into_iter()
        .flatten()
        .flatten();
    let columns = columns.chain(more);
    OutcomeColumns(columns.chain(counts).chain(times).collect())
}

/// What conditions can refer to of the columns of a document.
pub(crate) fn condition_columns(document: &Document) -> ConditionColumns {
    let items = ScenarioSpec::max_counts(document);
    let items: Vec<(&str, u32)> = items
        .iter()
        .map(|(name, count)| (name.as_str(), *count))
        .collect();
    let items = items.as_slice();
    let robots = ScenarioSpec::names(document, &["robots"]).unwrap_or_default();
    let robots: Vec<&str> = robots.iter().map(String::as_str).collect();
    let mines = ScenarioSpec::mines(document);
    let mines: Vec<&str> = mines.iter().map(String::as_str).collect();
    let names = [robots.as_slice(), &mines];
    let names = columns(items, names, ScenarioSpec::features(document)).names();
    let lengths = items.iter().map(|(_, count)| find_times(*count) as usize);
    let mut start = names.len() - lengths.clone().sum::<usize>();
    let mut times = Vec::new();
    for ((kind, _), length) in items.iter().zip(lengths).filter(|(_, length)| *length > 0) {
        times.push(TimesUntil {
            count: format!("found_{kind}"),
            places: start..start + length,
        });
        start += length;
    }
    ConditionColumns {
        unseen: unseen(document, &names),
        names,
        times,
    }
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
            |on| Bounds::up_to(on.max_targets().into()),
            |on, of| on.sum_of_targets(|kind| of.found[kind]).into(),
        )
        .with_term("found", 4),
        Column::new(
            "missed",
            Whole,
            |on| Bounds::up_to(on.max_targets().into()),
            |on, of| on.sum_of_targets(|kind| of.missed[kind]).into(),
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

/// The columns of the counts of one kind of items, by its number.
fn counts_of((number, (kind, _)): (usize, (&str, u32))) -> [Column; 2] {
    let of_all = move |on: &Scenario| Bounds::up_to(on.items[number].max_number().into());
    let found = move |_: &Scenario, of: &Outcome| of.found[number].into();
    let missed = move |_: &Scenario, of: &Outcome| of.missed[number].into();
    [
        Column::new(format!("found_{kind}"), Whole, of_all, found),
        Column::new(format!("missed_{kind}"), Whole, of_all, missed),
    ]
}

/// The columns of the times of the finds of one kind of items, by its number; the time of what was not found is
/// +infinity.
fn find_times_of(
    (number, (kind, max_count)): (usize, (&str, u32)),
) -> impl Iterator<Item = Column> {
    (0..find_times(max_count)).map(move |find| {
        let name = find_time(kind, find + 1);
        let time_s = move |_: &Scenario, of: &Outcome| {
            let found_s = of.found_s[number].get(find as usize);
            found_s.copied().unwrap_or(f64::INFINITY)
        };
        Column::new(name, Real, |_| Bounds::NOT_NEGATIVE, time_s)
    })
}

#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn count(events: u64) -> f64 {
    events as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merit_terms_are_summed_in_the_order_of_stored_studies() {
        let terms = columns(&[], [&[], &[]], Features::default()).merit_terms();
        let names: Vec<&str> = terms.iter().map(|term| &*term.name).collect();
        let expected = "time robots failed price found missed collisions energy distance stopped \
                        false_alarms";
        assert_eq!(names.join(" "), expected);
    }
}
