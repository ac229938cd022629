//! Checks that robots carry what their tools need.

use crate::scenario::spec::ScenarioSpec;
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
    errors.collect()
}
