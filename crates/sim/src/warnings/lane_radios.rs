//! Warnings about radios that are too narrow for the reports of robots about a mined lane.

use crate::radio::RadioSpec;
use crate::scenario::{Checked, ScenarioSpec};
use base::document::Place;
use base::warning::Warning;
use brain::{LANE_REPORT_MESSAGES, LANE_REPORT_PERIOD_S};

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    if !spec.has_clearance() {
        return Vec::new();
    }
    of_robots(spec, at)
        .into_iter()
        .chain(of_controllers(spec, at))
        .collect()
}

/// Kinds of robots that cannot send a report to each controller in a step.
fn of_robots(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let controllers: u32 = spec.controllers.values().map(|kind| kind.count).sum();
    let needed = LANE_REPORT_MESSAGES * controllers;
    let kinds = spec.robots.iter().filter(|(_, kind)| kind.count > 0);
    let found = kinds.filter_map(|(name, kind)| {
        let effect = "that a report about the lane needs: controllers may miss marks and coverage";
        too_narrow(
            kind.radio.as_ref()?,
            needed,
            effect,
            &at.key("robots").key(name),
        )
    });
    found.collect()
}

/// Kinds of controllers that cannot receive the reports of all robots.
fn of_controllers(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let robots: u32 = spec.robots.values().map(|kind| kind.count).sum();
    let steps = LANE_REPORT_PERIOD_S / spec.clock.step_s;
    let per_step = f64::from(LANE_REPORT_MESSAGES * robots) / steps.max(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small count"
    )]
    let needed = per_step.ceil() as u32;
    let kinds = spec.controllers.iter();
    let found = kinds.filter(|(_, kind)| kind.count > 0 && kind.clearance.is_some());
    let found = found.filter_map(|(name, kind)| {
        let effect =
            "that the robots report about the lane in a step: marks and coverage may be lost";
        too_narrow(
            &kind.radio,
            needed,
            effect,
            &at.key("controllers").key(name),
        )
    });
    found.collect()
}

fn too_narrow(radio: &RadioSpec, needed: u32, effect: &str, at: &Place) -> Option<Warning> {
    let at = at.key("radio").key("messages_per_step");
    let effect = format!("fewer than the {needed} {effect}");
    (radio.messages_per_step < needed).then(|| at.warning(effect))
}
