//! Checks of the items that detectors cannot detect, and of the kinds that they report.

use super::names::{allowed, is_fine};
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::Measures;
use crate::sensors::confusion::ROW_TOLERANCE;
use crate::sensors::items::ItemsSpec;
use base::document::Place;
use base::error::InputError;
use base::random::kind_key;
use std::collections::BTreeMap;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let kinds: Vec<&str> = spec.items.keys().map(String::as_str).collect();
    let mut models = BTreeMap::new();
    let mut errors = Vec::new();
    for (owner, robot) in &spec.robots {
        let at = at.key("robots").key(owner).key("sensors");
        for (name, sensor) in &robot.sensors {
            if let Measures::Items(items) = &sensor.measures {
                let at = at.key(name);
                errors.extend(blind_shares(items, &kinds, &at));
                errors.extend(confusion(items, &kinds, &at));
                errors.extend(model(items, (owner, name), &mut models, &at));
            }
        }
    }
    errors
}

/// The true kinds of a table, each with its error: unknown, or never detected, so that the value would have no
/// effect.
fn unfit(items: &ItemsSpec, kind: &str, kinds: &[&str], at: &Place) -> Option<InputError> {
    let detected = items.detection_probability.as_ref();
    let is_detected = detected.is_none_or(|detected| detected.contains_key(kind));
    unknown(kind, kinds, at).or_else(|| {
        (!is_detected).then(|| {
            at.key(kind).error(
                "removed, or the kind added to detection_probability: the sensor never detects it",
            )
        })
    })
}

fn unknown(kind: &str, kinds: &[&str], at: &Place) -> Option<InputError> {
    let is_known = kinds.contains(&kind);
    (!is_known).then(|| at.key(kind).unknown_key(kind, kinds.iter().copied()))
}

fn out_of_range(share: f64, at: &Place) -> Option<InputError> {
    let is_share = (0.0..=1.0).contains(&share);
    (!is_share).then(|| at.error("a number from 0 to 1"))
}

fn blind_shares(items: &ItemsSpec, kinds: &[&str], at: &Place) -> Vec<InputError> {
    let at = at.key("blind_share");
    let mut errors = Vec::new();
    for (kind, share) in &items.blind_share {
        errors.extend(unfit(items, kind, kinds, &at));
        errors.extend(out_of_range(*share, &at.key(kind)));
    }
    errors
}

fn confusion(items: &ItemsSpec, kinds: &[&str], at: &Place) -> Vec<InputError> {
    let at = at.key("confusion");
    let mut errors = Vec::new();
    for (kind, row) in &items.confusion {
        errors.extend(unfit(items, kind, kinds, &at));
        let at = at.key(kind);
        let mut wrong = Vec::new();
        for (reported, share) in row {
            wrong.extend(unknown(reported, kinds, &at));
            wrong.extend(out_of_range(*share, &at.key(reported)));
        }
        let sum = row.values().fold(0.0, |sum, share| sum + share);
        if wrong.is_empty() && (sum - 1.0).abs() > ROW_TOLERANCE {
            wrong.push(at.error(format!(
                "probabilities that sum to 1, one for each reported kind; they sum to {sum}"
            )));
        }
        errors.extend(wrong);
    }
    errors
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
