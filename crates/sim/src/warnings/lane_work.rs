//! Warnings about sensors and tools that may not reach mines from where these cannot destroy the robot.

use crate::scenario::Checked;
use crate::scenario::lane_work::{WorkReach, reaches};
use base::document::Place;
use base::warning::Warning;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    let kinds = spec.controllers.values();
    let reaches = kinds.flat_map(|kind| {
        let clearance = kind.clearance.iter().filter(|_| kind.count > 0);
        clearance.flat_map(|clearance| reaches(clearance, spec))
    });
    let short = reaches.filter(|reach| reach.range_m < reach.safe_m);
    let short = short.map(|reach| {
        let robot = at.key("robots").key(reach.robot);
        let at = reach.keys.iter().fold(robot, |at, key| at.key(key));
        at.key("range_m").warning(effect(&reach))
    });
    short.collect()
}

fn effect(reach: &WorkReach) -> String {
    format!(
        "it may not reach {} from where that cannot destroy the robot: {} m with exact positions, {:.2} m with their errors; \
         set at least {:.2}",
        reach.item, reach.min_m, reach.safe_m, reach.safe_m
    )
}
