//! Checks that robots carry what their tools need, and that some robots have the tools that complete items.

use crate::scenario::spec::ScenarioSpec;
use crate::world::items::CompletedBy;
use base::document::Place;
use base::error::InputError;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let robots = spec.robots.iter();
    let without =
        robots.filter(|(_, robot)| robot.tools.neutralise.is_some() && robot.payload_kg <= 0.0);
    let errors = without.map(|(name, _)| {
        let allowed = "the mass of the charges of tools.neutralise and of any other payload: a number above 0 (kg)";
        at.key("robots").key(name).key("payload_kg").error(allowed)
    });
    let mut errors: Vec<InputError> = errors.collect();
    errors.extend(of_items(spec, at));
    errors
}

/// Targets that no robot can complete.
fn of_items<'s>(spec: &'s ScenarioSpec, at: &'s Place) -> impl Iterator<Item = InputError> + 's {
    let targets = spec.items.iter().filter(|(_, kind)| kind.target);
    targets.filter_map(move |(name, kind)| {
        let mut tools = spec.robots.values().map(|robot| &robot.tools);
        let (has_tool, tool) = match kind.completed_by {
            CompletedBy::Detected => return None,
            CompletedBy::Confirmed => (tools.any(|tools| tools.confirm.is_some()), "confirm"),
            CompletedBy::Neutralised => {
                (tools.any(|tools| tools.neutralise.is_some()), "neutralise")
            }
        };
        let allowed = format!("\"detected\", unless a kind of robots has tools.{tool}");
        let at = at.key("items").key(name).key("completed_by");
        (!has_tool).then(|| at.error(allowed))
    })
}
