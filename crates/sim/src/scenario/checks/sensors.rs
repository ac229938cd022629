//! Checks of sensors: each of its own, and the names of sensor models.

use super::names::{allowed, is_fine};
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::SensorSpec;
use crate::sensors::items::ItemsSpec;
use crate::sensors::sensor_kind::AmongKinds;
use base::document::Place;
use base::error::InputError;
use base::random::kind_key;
use std::collections::BTreeMap;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let robots = spec.robots.iter().map(|(owner, of)| {
        let at = at.key("robots").key(owner);
        (at, owner, &of.sensors)
    });
    let controllers = spec.controllers.iter().map(|(owner, of)| {
        let at = at.key("controllers").key(owner);
        (at, owner, &of.sensors)
    });
    let mut models = BTreeMap::new();
    let mut errors = Vec::new();
    for (at, owner, sensors) in robots.chain(controllers) {
        let at = at.key("sensors");
        for (name, sensor) in sensors {
            let at = at.key(name);
            errors.extend(of_sensor(sensor, (owner, name), spec, &at));
            if let Some(items) = ItemsSpec::of(&sensor.measures) {
                errors.extend(model(items, (owner, name), &mut models, &at));
            }
        }
    }
    errors
}

fn of_sensor(
    sensor: &SensorSpec,
    names: (&str, &str),
    spec: &ScenarioSpec,
    at: &Place,
) -> Vec<InputError> {
    let item_kinds: Vec<String> = spec.items.keys().cloned().collect();
    // The number matters only for brains.
    let context = sensor.context(0, names, &item_kinds, spec.clock.step_s);
    sensor.measures.errors(&context, at)
}

/// A bad name of a model, or one whose hash is that of another model.
fn model(
    items: &ItemsSpec,
    (owner, name): (&str, &str),
    models: &mut BTreeMap<u32, String>,
    at: &Place,
) -> Option<InputError> {
    let at = at.key("model");
    if items.model.as_ref().is_some_and(|model| !is_fine(model)) {
        return Some(at.error(allowed()));
    }
    let model = items.model_name(owner, name);
    let known = models.entry(kind_key(&model)).or_insert(model.clone());
    (*known != model).then(|| {
        at.error(format!(
            "a different name: the hash that keys its random numbers equals that of {known}"
        ))
    })
}
