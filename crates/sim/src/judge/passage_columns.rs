//! The outcome columns of vehicles that are to pass a lane, and of the share of its mines that are cleared.

use super::conclusion_tally::StatedClearance;
use super::goal_columns::Column;
use super::passage_outcome::PassageOutcome;
use crate::scenario::Scenario;
use base::engine::Bounds;
use base::engine::ColumnKind::{self, Flag, Real, Whole};

/// Columns of the stated and the true share of these kinds of mines that are cleared.
pub(super) fn of_mines(mines: &[&str]) -> Vec<Column> {
    let each = mines.iter().flat_map(|mine| {
        [
            share(
                format!("stated_clearance_{mine}"),
                mine,
                |of| of.stated,
                0.0,
            ),
            share(
                format!("stated_clearance_{mine}_low"),
                mine,
                |of| of.low,
                0.0,
            ),
            share(
                format!("stated_clearance_{mine}_high"),
                mine,
                |of| of.high,
                1.0,
            ),
            share(format!("true_clearance_{mine}"), mine, |of| of.truth, 0.0),
        ]
    });
    each.collect()
}

/// A column of the share of a kind of mines; `unstated` without a statement.
fn share(name: String, mine: &str, value: fn(&StatedClearance) -> f64, unstated: f64) -> Column {
    let mine = mine.to_owned();
    Column::new(
        name,
        Real,
        |_| Bounds::up_to(1.0),
        move |on, outcome| {
            let mut stated = outcome.cleared.iter();
            let own = stated.find(|of| on.items[of.kind].name == mine);
            own.map_or(unstated, value)
        },
    )
}

/// Columns of the passage.
pub(super) fn columns() -> Vec<Column> {
    let share = |_: &Scenario| Bounds::up_to(1.0);
    let flag = |is: bool| f64::from(u8::from(is));
    let vehicles = |on: &Scenario| {
        let passage = on.passage.map_or(0, |passage| passage.vehicles);
        Bounds::up_to(passage.into())
    };
    let time = |on: &Scenario| Bounds::up_to(on.longest_s());
    let any = |_: &Scenario| Bounds::NOT_NEGATIVE;
    vec![
        column("stated_first_risk", Real, share, |of| of.first_risk),
        column("stated_last_risk", Real, share, |of| of.last_risk),
        column("first_lost", Flag, share, move |of| flag(of.first_lost))
            .with_term("first_lost", 60),
        column("last_lost", Flag, share, move |of| flag(of.last_lost)),
        column("vehicles_passed", Whole, vehicles, |of| of.passed.into())
            .with_term("vehicles_passed", 61),
        column("vehicles_lost", Whole, vehicles, |of| of.lost.into())
            .with_term("vehicles_lost", 62),
        column("passed_s", Real, time, |of| of.passed_s).with_term("passed", 63),
        column("path_m", Real, any, |of| of.length_m),
        column("mines_on_path", Whole, any, |of| of.mines_on_path.into()),
    ]
}

fn column(
    name: &'static str,
    kind: ColumnKind,
    bounds: impl Fn(&Scenario) -> Bounds + Send + Sync + 'static,
    value: impl Fn(&PassageOutcome) -> f64 + Send + Sync + 'static,
) -> Column {
    Column::new(name, kind, bounds, move |_, outcome| {
        outcome.passage.as_ref().map_or(0.0, &value)
    })
}
