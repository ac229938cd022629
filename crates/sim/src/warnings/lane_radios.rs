//! Warnings about radios that are too narrow for the reports of robots about a mined lane.

use crate::radio::RadioSpec;
use crate::scenario::{Checked, ScenarioSpec};
use base::document::Place;
use base::warning::Warning;
use brain::behaviours::BehaviourSpec;
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
    let found = reporting(spec).filter_map(|(name, _, radio)| {
        let effect = "of a report about the lane: controllers may miss marks and coverage";
        too_narrow(radio, needed, effect, &at.key("robots").key(name))
    });
    found.collect()
}

/// Kinds of controllers that cannot receive the reports of a step. The robots of a kind report in turn.
fn of_controllers(spec: &ScenarioSpec, at: &Place) -> Vec<Warning> {
    let steps = (LANE_REPORT_PERIOD_S / spec.clock.step_s).round().max(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "counts"
    )]
    let at_once = reporting(spec).map(|(_, count, _)| (f64::from(count) / steps).ceil() as u32);
    let needed = LANE_REPORT_MESSAGES.saturating_mul(at_once.sum());
    let kinds = spec.controllers.iter();
    let found = kinds.filter(|(_, kind)| kind.count > 0 && kind.clearance.is_some());
    let found = found.filter_map(|(name, kind)| {
        let effect = "of the reports that arrive in one step: marks and coverage may be lost";
        too_narrow(
            &kind.radio,
            needed,
            effect,
            &at.key("controllers").key(name),
        )
    });
    found.collect()
}

/// The kinds of robots that report about a lane, with their counts and radios.
fn reporting(spec: &ScenarioSpec) -> impl Iterator<Item = (&String, u32, &RadioSpec)> {
    let kinds = spec.robots.iter().filter(|(_, kind)| kind.count > 0);
    kinds.filter_map(|(name, kind)| {
        let mut behaviours = kind.brain.behaviours.iter();
        let serves = behaviours.any(|one| matches!(one, BehaviourSpec::Serve(_)));
        Some((name, kind.count, kind.radio.as_ref().filter(|_| serves)?))
    })
}

fn too_narrow(radio: &RadioSpec, needed: u32, effect: &str, at: &Place) -> Option<Warning> {
    let at = at.key("radio").key("messages_per_step");
    let effect = format!("fewer than the {needed} messages {effect}");
    (radio.messages_per_step < needed).then(|| at.warning(effect))
}
