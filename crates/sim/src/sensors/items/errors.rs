//! Checks of item detectors: that they detect existing items, with valid probabilities; of the items that they cannot
//! detect, of what items look like to them, and of the kinds that they report: in truth, and as believed.

use super::spec::ItemsSpec;
use crate::poisson::MAX_MEAN;
use crate::sensors::confusion::{ConfusionSpec, ROW_TOLERANCE};
use crate::sensors::detection::Detection;
use crate::sensors::sensor_kind::SensorContext;
use base::document::Place;
use base::error::InputError;
use std::collections::BTreeMap;

/// Maximum false alarm rate, so that a typing error is reported instead of simulated.
const MAX_FALSE_ALARMS: f64 = 1000.0;

pub(super) fn errors(items: &ItemsSpec, context: &SensorContext, at: &Place) -> Vec<InputError> {
    let kinds: Vec<&str> = context.item_kinds.iter().map(String::as_str).collect();
    let mut errors = of_detection(items, &kinds, at);
    errors.extend(too_many(items, context.period_s, at));
    errors.extend(of_identification(items, context.item_kinds, at));
    errors
}

fn of_identification(items: &ItemsSpec, item_kinds: &[String], at: &Place) -> Vec<InputError> {
    let kinds: Vec<&str> = item_kinds.iter().map(String::as_str).collect();
    let fits = Fits::new(items, &kinds);
    let mut errors = fits.blind_shares(&items.blind_share, at);
    errors.extend(fits.lookalikes(&items.lookalike_share, at));
    errors.extend(fits.confusion(&items.confusion, at));
    if let Some(believed) = &items.believed {
        let at = at.key("believed");
        let fits = Fits::new(&items.as_believed(item_kinds.iter()), &kinds);
        errors.extend(fits.blind_shares(&believed.blind_share, &at));
        errors.extend(fits.lookalikes(&believed.lookalike_share, &at));
        errors.extend(fits.confusion(&believed.confusion, &at));
    }
    errors
}

/// Unknown kinds, tables that are none, and rates out of range.
fn of_detection(items: &ItemsSpec, kinds: &[&str], at: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    let believed = items.believed.as_ref();
    let tables = [
        (at.clone(), items.detection_probability.as_ref()),
        (
            at.key("believed"),
            believed.map(|each| &each.detection_probability),
        ),
    ];
    for (at, table) in tables {
        let at = at.key("detection_probability");
        for (kind, detection) in table.into_iter().flatten() {
            errors.extend(unknown(kind, kinds, &at));
            errors.extend(detection.error(&at.key(kind)));
        }
    }
    let alarms = at.key("false_alarm_rate_per_m2_s");
    for (kind, rate) in &items.false_alarm_rate_per_m2_s {
        errors.extend(unknown(kind, kinds, &alarms));
        if !(0.0..=MAX_FALSE_ALARMS).contains(rate) {
            let allowed = format!("a number from 0 to {MAX_FALSE_ALARMS}");
            errors.push(alarms.key(kind).error(allowed));
        }
    }
    errors
}

/// More false alarms than one measurement can yield.
fn too_many(items: &ItemsSpec, period_s: f64, at: &Place) -> Vec<InputError> {
    let rates = items.false_alarm_rate_per_m2_s.iter();
    let rates = rates.filter(|(_, rate)| (0.0..=MAX_FALSE_ALARMS).contains(*rate));
    let means = rates.map(|(kind, _)| (kind, items.false_alarms_per_measurement(kind, period_s)));
    let errors = means.filter(|(_, mean)| *mean > MAX_MEAN).map(|(kind, mean)| {
        let allowed = format!(
            "lower, so that a measurement has at most {MAX_MEAN} false alarms; in its whole range and \
             {period_s} s it has {mean:.0}"
        );
        at.key("false_alarm_rate_per_m2_s").key(kind).error(allowed)
    });
    errors.collect()
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
