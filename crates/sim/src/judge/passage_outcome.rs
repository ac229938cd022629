//! The outcome of vehicles that were to pass a lane.

use super::moment::Moment;
use crate::clock::seconds;
use crate::passage::VehicleStatus;

/// What was stated of the passage of a lane, and what became of the vehicles.
#[derive(Debug, Clone, PartialEq)]
pub struct PassageOutcome {
    /// The risk that was stated of the first vehicle; 1 if no path was stated.
    pub first_risk: f64,
    /// That of the last one.
    pub last_risk: f64,
    /// Whether a mine destroyed the first vehicle.
    pub first_lost: bool,
    /// Whether a mine destroyed the last one.
    pub last_lost: bool,
    /// Vehicles that have reached the other end of the lane.
    pub passed: u32,
    /// Vehicles that mines destroyed.
    pub lost: u32,
    /// Length of the path that was stated; 0 if none was.
    pub length_m: f64,
    /// Mines within the width of the path when it was stated.
    pub mines_on_path: u32,
    /// Time until each vehicle had passed or was destroyed; the time limit if some had not.
    pub passed_s: f64,
}

impl PassageOutcome {
    pub(super) fn of(moment: &Moment) -> Self {
        let scenario = moment.scenario;
        let conclusion = moment.tally.conclusion.as_deref();
        let planned = conclusion.and_then(|conclusion| conclusion.passage.as_ref());
        let vehicles = moment.convoy.map_or(&[][..], |convoy| &convoy.vehicles);
        let lost = |vehicle: &crate::passage::convoy::Moving| vehicle.status == VehicleStatus::Lost;
        let count = |status: VehicleStatus| {
            let same = vehicles.iter().filter(|vehicle| vehicle.status == status);
            u32::try_from(same.count()).unwrap_or(u32::MAX)
        };
        let ended_at = moment.convoy.and_then(|convoy| convoy.ended_at);
        let ended_s = ended_at.map(|tick| seconds(tick + 1, scenario.step_s));
        Self {
            first_risk: planned.map_or(1.0, economy::PlannedPassage::first_risk),
            last_risk: planned.map_or(1.0, economy::PlannedPassage::last_risk),
            first_lost: vehicles.first().is_some_and(lost),
            last_lost: vehicles.last().is_some_and(lost),
            passed: count(VehicleStatus::Passed),
            lost: count(VehicleStatus::Lost),
            length_m: planned.map_or(0.0, |planned| planned.length_m),
            mines_on_path: conclusion.map_or(0, |conclusion| conclusion.mines_on_path),
            passed_s: ended_s.map_or(scenario.time_limit_s, |ended_s| {
                ended_s.min(scenario.time_limit_s)
            }),
        }
    }
}
