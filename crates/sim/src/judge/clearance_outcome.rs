//! The outcome of a lane that controllers were to clear.

use super::clearance_tally::{ClearanceTally, Remains, Stated};
use super::end::LaneEnd;
use super::moment::Moment;
use crate::clock::seconds;

/// What controllers stated of a lane, and whether that was true.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearanceOutcome {
    /// Whether it was declared clear.
    pub is_declared: bool,
    /// Whether it was declared clear and no mine was left in it.
    pub is_clear: bool,
    /// Whether the controllers that work gave it up.
    pub is_given_up: bool,
    /// The risk that was stated when it was declared clear or given up; 1 if it was neither.
    pub stated_risk: f64,
    /// Mines without a mark that the controller expected to be left then; 0 if it was neither, as for the next three.
    pub stated_unmarked: f64,
    /// Mines at marks that it expected to be left.
    pub stated_marked: f64,
    /// Mines that were left and belong to the first number.
    pub left_unmarked: f64,
    /// Mines that were left and belong to the second number.
    pub left_marked: f64,
    /// Time until it was declared clear; the time limit if it was not.
    pub declared_s: f64,
    /// Time until it was given up; the time limit if it was not.
    pub given_up_s: f64,
    /// Why the run was over; none while it is not, and if the condition of `[end]` ended it.
    pub end: Option<LaneEnd>,
    /// Time until all marks that may be mines had a verdict; the time limit if some had none at the end.
    pub interrogated_s: f64,
    /// Mean time for which robots of each kind were active.
    pub on_station_s: Vec<f64>,
    /// What the robots of each kind have used, including those that were removed.
    pub used: Vec<KindUse>,
    /// Messages sent.
    pub messages_sent: u64,
    /// Messages that a participant could not send or receive, because there were too many in a step.
    pub messages_dropped: u64,
    /// Goals awarded to robots.
    pub awards: u64,
    /// Awards of a goal to another robot than before.
    pub reallocations: u64,
}

impl ClearanceOutcome {
    pub(super) fn of(moment: &Moment, tally: &ClearanceTally) -> Self {
        let scenario = moment.scenario;
        let time_s = |at: Option<u64>| {
            let time_s = at.map(|tick| seconds(tick, scenario.step_s));
            time_s.map_or(scenario.time_limit_s, |time_s| {
                time_s.min(scenario.time_limit_s)
            })
        };
        let declared: Option<Stated> = tally.stated.filter(|stated| stated.is_clear);
        let given_up: Option<Stated> = tally.stated.filter(|stated| !stated.is_clear);
        let remains = tally
            .stated
            .map_or(Remains::default(), |stated| stated.remains);
        let kinds = scenario.kinds.iter().zip(&tally.on_station);
        Self {
            is_declared: declared.is_some(),
            is_clear: declared.is_some_and(|stated| stated.remains.mines == 0),
            is_given_up: given_up.is_some(),
            stated_risk: tally.stated.map_or(1.0, |stated| stated.risk),
            stated_unmarked: remains.believed_unmarked,
            stated_marked: remains.believed_marked,
            left_unmarked: f64::from(remains.mines) - remains.at_marks,
            left_marked: remains.at_marks,
            declared_s: time_s(declared.map(|stated| stated.at)),
            given_up_s: time_s(given_up.map(|stated| stated.at)),
            end: moment.lane_end(tally),
            interrogated_s: time_s(tally.interrogated_at),
            on_station_s: kinds
                .map(|(kind, steps)| {
                    seconds(*steps, scenario.step_s) / f64::from(kind.count.max(1))
                })
                .collect(),
            used: used(moment),
            messages_sent: tally.messages_sent,
            messages_dropped: tally.messages_dropped,
            awards: tally.awards,
            reallocations: tally.reallocations,
        }
    }
}

/// What the robots of a kind have used.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct KindUse {
    /// Charges.
    pub charges: u64,
    /// Energy.
    pub energy_j: f64,
    /// Distance.
    pub distance_m: f64,
}

/// What the robots of each kind have used. Robots are in the order of their kinds.
fn used(moment: &Moment) -> Vec<KindUse> {
    let Moment {
        scenario, tally, ..
    } = moment;
    let mut bodies = moment.body_states.iter();
    let used = scenario.kinds.iter().map(|kind| {
        let removed = tally.removed_of.get(&kind.key).copied().unwrap_or_default();
        let cost = removed.and(bodies.by_ref().take(kind.count as usize));
        let charges = tally.acts.as_deref();
        KindUse {
            charges: charges.map_or(0, |acts| acts.charges_of(kind.key)),
            energy_j: cost.energy_j,
            distance_m: cost.distance_m,
        }
    });
    used.collect()
}
