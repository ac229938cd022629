//! The outcome columns of scenarios in which controllers are to clear a lane.

use super::clearance_outcome::ClearanceOutcome;
use super::end::LaneEnd;
use super::goal_columns::Column;
use crate::scenario::Scenario;
use crate::scenario::features::Features;
use base::engine::Bounds;
use base::engine::ColumnKind::{self, Flag, Real, Whole};
use std::borrow::Cow;

/// Columns of the statement and its truth, of the end, of times, with those of these kinds of robots and what these have
/// used, and of messages, unless those of goals contain them.
pub(super) fn columns(robots: &[&str], has: Features) -> Vec<Column> {
    let mut columns = statement();
    columns.extend(remains());
    columns.extend(ends());
    columns.extend(times());
    columns.extend(robots.iter().enumerate().map(on_station));
    columns.extend(robots.iter().enumerate().flat_map(used));
    columns.extend(counts());
    if !has.goals {
        columns.extend(messages());
    }
    columns
}

fn statement() -> Vec<Column> {
    let share = |_: &Scenario| Bounds::up_to(1.0);
    let flag = |is: bool| f64::from(u8::from(is));
    vec![
        column("declared", Flag, share, move |of| flag(of.is_declared)).with_term("declared", 31),
        column("declared_clear", Flag, share, move |of| flag(of.is_clear))
            .with_term("declared_clear", 32),
        column("declared_not_clear", Flag, share, move |of| {
            flag(of.is_declared && !of.is_clear)
        })
        .with_term("declared_not_clear", 33),
        column("given_up", Flag, share, move |of| flag(of.is_given_up)).with_term("given_up", 38),
        column("stated_risk", Real, share, |of| of.stated_risk).with_term("stated_risk", 34),
    ]
}

/// The two parts of the risk, as the controller stated them and as they were.
fn remains() -> Vec<Column> {
    let count = |_: &Scenario| Bounds::NOT_NEGATIVE;
    vec![
        column("stated_unmarked", Real, count, |of| of.stated_unmarked),
        column("stated_marked", Real, count, |of| of.stated_marked),
        column("left_unmarked", Real, count, |of| of.left_unmarked),
        column("left_marked", Real, count, |of| of.left_marked),
    ]
}

/// Why a run is over, besides a declaration.
fn ends() -> Vec<Column> {
    let end = |name: &'static str, end: LaneEnd| {
        let share = |_: &Scenario| Bounds::up_to(1.0);
        column(name, Flag, share, move |of| {
            f64::from(u8::from(of.end == Some(end)))
        })
    };
    vec![
        end("ended_hopeless", LaneEnd::Hopeless),
        end("ended_called_off", LaneEnd::CalledOff),
        end("ended_controllers_lost", LaneEnd::ControllersLost),
        end("ended_robots_lost", LaneEnd::RobotsLost),
        end("ended_time_limit", LaneEnd::TimeLimit),
    ]
}

fn times() -> Vec<Column> {
    let time = |on: &Scenario| Bounds::up_to(on.longest_s());
    vec![
        column("declared_s", Real, time, |of| of.declared_s),
        column("given_up_s", Real, time, |of| of.given_up_s),
        column("interrogated_s", Real, time, |of| of.interrogated_s).with_term("interrogated", 35),
    ]
}

/// The mean time for which robots of a kind were active.
fn on_station((number, name): (usize, &&str)) -> Column {
    let time = |on: &Scenario| Bounds::up_to(on.longest_s());
    column(format!("on_station_{name}_s"), Real, time, move |of| {
        of.on_station_s.get(number).copied().unwrap_or_default()
    })
}

/// What all robots of a kind have used.
fn used((kind, name): (usize, &&str)) -> [Column; 3] {
    let of = move |of: &ClearanceOutcome| of.used.get(kind).copied().unwrap_or_default();
    let charges = move |_: &Scenario| Bounds::NOT_NEGATIVE;
    let energy = move |on: &Scenario| Bounds::up_to(on.max_energy_of_j(kind));
    let distance = move |on: &Scenario| Bounds::up_to(on.max_distance_of_m(kind));
    [
        column(format!("charges_used_{name}"), Whole, charges, move |all| {
            number(of(all).charges)
        }),
        column(format!("energy_{name}_j"), Real, energy, move |all| {
            of(all).energy_j
        }),
        column(format!("distance_{name}_m"), Real, distance, move |all| {
            of(all).distance_m
        }),
    ]
}

fn counts() -> Vec<Column> {
    let count = |_: &Scenario| Bounds::NOT_NEGATIVE;
    vec![
        column("awards", Whole, count, |of| number(of.awards)).with_capped_term("awards", 36, 1e4),
        column("reallocations", Whole, count, |of| number(of.reallocations)).with_capped_term(
            "reallocations",
            37,
            1e4,
        ),
    ]
}

fn messages() -> Vec<Column> {
    let count = |_: &Scenario| Bounds::NOT_NEGATIVE;
    vec![
        column("messages_sent", Whole, count, |of| number(of.messages_sent)).with_capped_term(
            "messages_sent",
            18,
            1e6,
        ),
        column("messages_dropped", Whole, count, |of| {
            number(of.messages_dropped)
        })
        .with_capped_term("messages_dropped", 19, 1e6),
    ]
}

fn column(
    name: impl Into<Cow<'static, str>>,
    kind: ColumnKind,
    bounds: impl Fn(&Scenario) -> Bounds + Send + Sync + 'static,
    value: impl Fn(&ClearanceOutcome) -> f64 + Send + Sync + 'static,
) -> Column {
    Column::new(name, kind, bounds, move |_, outcome| {
        outcome.clearance.as_ref().map_or(0.0, &value)
    })
}

#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn number(count: u64) -> f64 {
    count as f64
}
