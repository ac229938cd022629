//! The outcome columns of scenarios in which robots act on items, or items destroy robots.

use super::act_outcome::ActOutcome;
use super::goal_columns::Column;
use crate::scenario::Scenario;
use base::engine::Bounds;
use base::engine::ColumnKind::Whole;
use brain::MAX_ACTS;

/// Columns of the counts of acts, of the targets that are left, and of the robots that are lost.
pub(super) fn columns() -> Vec<Column> {
    vec![
        targets("marked", |acts| acts.marked, 22),
        places("false_marks", |acts| acts.false_marks, 23),
        targets("confirmed", |acts| acts.confirmed, 24),
        places("false_confirmations", |acts| acts.false_confirmations, 25),
        targets("neutralised", |acts| acts.neutralised, 26),
        targets("left", |acts| acts.left, 27),
        count(
            "robots_lost",
            Scenario::max_robots_lost,
            |acts| acts.robots_lost,
            28,
        ),
        targets("unmarked_from_air", |acts| acts.unmarked_from_air, 29),
        targets("met_unmarked", |acts| acts.met_unmarked, 30),
    ]
}

fn targets(name: &'static str, value: fn(&ActOutcome) -> u32, term: u8) -> Column {
    count(name, |on| on.max_targets().into(), value, term)
}

fn places(name: &'static str, value: fn(&ActOutcome) -> u32, term: u8) -> Column {
    count(name, Scenario::max_acts, value, term)
}

fn count(
    name: &'static str,
    max: fn(&Scenario) -> f64,
    value: fn(&ActOutcome) -> u32,
    term: u8,
) -> Column {
    let bounds = move |on: &Scenario| Bounds::up_to(max(on));
    let column = Column::new(name, Whole, bounds, move |_, of| {
        of.acts.as_ref().map_or(0.0, |acts| value(acts).into())
    });
    column.with_term(name, term.into())
}

impl Scenario {
    fn max_robots_lost(&self) -> f64 {
        self.team_size()
    }

    /// The largest number of acts in a run.
    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    fn max_acts(&self) -> f64 {
        self.team_size() * MAX_ACTS as f64 * (self.steps as f64)
    }
}
