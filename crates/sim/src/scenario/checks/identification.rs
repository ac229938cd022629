//! Checks of the items that detectors cannot detect, of what items look like to them, and of the kinds that they report:
//! in truth, and as believed.

use super::names::{allowed, is_fine};
use crate::scenario::spec::ScenarioSpec;
use crate::sensors::Measures;
use crate::sensors::confusion::{ConfusionSpec, ROW_TOLERANCE};
use crate::sensors::detection::Detection;
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
                let fits = |items: &ItemsSpec| Fits::new(items, &kinds);
                errors.extend(fits(items).blind_shares(&items.blind_share, &at));
                errors.extend(fits(items).lookalikes(&items.lookalike_share, &at));
                errors.extend(fits(items).confusion(&items.confusion, &at));
                if let Some(believed) = &items.believed {
                    let at = at.key("believed");
                    let fits = fits(&items.as_believed(spec.items.keys()));
                    errors.extend(fits.blind_shares(&believed.blind_share, &at));
                    errors.extend(fits.lookalikes(&believed.lookalike_share, &at));
                    errors.extend(fits.confusion(&believed.confusion, &at));
                }
                errors.extend(model(items, (owner, name), &mut models, &at));
            }
        }
    }
    errors
}

/// What the tables of a sensor may name: the kinds of items, which of them it detects, and which look like other kinds.
struct Fits<'k> {
    kinds: &'k [&'k str],
    detected: Option<Vec<String>>,
    lookalikes: ConfusionSpec,
}

impl<'k> Fits<'k> {
    fn new(items: &ItemsSpec, kinds: &'k [&'k str]) -> Self {
        let names = |of: &BTreeMap<String, Detection>| of.keys().cloned().collect();
        Self {
            kinds,
            detected: items.detection_probability.as_ref().map(names),
            lookalikes: items.lookalike_share.clone(),
        }
    }

    /// The error of a kind in a table: unknown, or never detected, so that the value would have no effect.
    fn unfit(&self, kind: &str, at: &Place) -> Option<InputError> {
        let detected = self.detected.as_ref();
        let is_detected =
            detected.is_none_or(|detected| detected.iter().any(|known| known == kind));
        unknown(kind, self.kinds, at).or_else(|| {
            (!is_detected).then(|| {
                at.key(kind).error(
                    "removed, or the kind added to detection_probability: the sensor never detects it",
                )
            })
        })
    }

    fn blind_shares(&self, shares: &BTreeMap<String, f64>, at: &Place) -> Vec<InputError> {
        let at = at.key("blind_share");
        let mut errors = Vec::new();
        for (kind, share) in shares {
            // What looks like another kind may be detected as that.
            if !self.lookalikes.contains_key(kind) {
                errors.extend(self.unfit(kind, &at));
            }
            errors.extend(out_of_range(*share, &at.key(kind)));
        }
        errors
    }

    fn lookalikes(&self, shares: &ConfusionSpec, at: &Place) -> Vec<InputError> {
        let at = at.key("lookalike_share");
        let mut errors = Vec::new();
        for (kind, row) in shares {
            errors.extend(unknown(kind, self.kinds, &at));
            let at = at.key(kind);
            let mut wrong = Vec::new();
            for (like, share) in row {
                wrong.extend(self.unfit(like, &at));
                wrong.extend(out_of_range(*share, &at.key(like)));
                if like == kind {
                    let allowed = "removed: what looks like no other kind looks like what it is";
                    wrong.push(at.key(like).error(allowed));
                }
            }
            let sum = row.values().fold(0.0, |sum, share| sum + share);
            if wrong.is_empty() && sum > 1.0 + ROW_TOLERANCE {
                wrong.push(at.error(format!("shares of at most 1 together; they sum to {sum}")));
            }
            errors.extend(wrong);
        }
        errors
    }

    fn confusion(&self, shares: &ConfusionSpec, at: &Place) -> Vec<InputError> {
        let at = at.key("confusion");
        let mut errors = Vec::new();
        for (kind, row) in shares {
            errors.extend(self.unfit(kind, &at));
            let at = at.key(kind);
            let mut wrong = Vec::new();
            for (reported, share) in row {
                wrong.extend(unknown(reported, self.kinds, &at));
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
}

fn unknown(kind: &str, kinds: &[&str], at: &Place) -> Option<InputError> {
    let is_known = kinds.contains(&kind);
    (!is_known).then(|| at.key(kind).unknown_key(kind, kinds.iter().copied()))
}

fn out_of_range(share: f64, at: &Place) -> Option<InputError> {
    let is_share = (0.0..=1.0).contains(&share);
    (!is_share).then(|| at.error("a number from 0 to 1"))
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
