//! The keys of an item detector.

use crate::sensors::believed::BelievedSpec;
use crate::sensors::detection::Detection;
use crate::sensors::lookalikes::appearances;
use crate::sensors::sector::{Sector, SectorSpec, yes};
use base::random::kind_key;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A detector of items within a sector; each measurement of each item is an independent draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemsSpec {
    /// The field of view.
    #[serde(flatten)]
    pub sector: SectorSpec,
    /// Probability of detection per look (one measurement), for each kind of item that the sensor
    /// can detect. Without it, the sensor always detects all kinds. `agent-economy check` prints
    /// the probability of detection in a whole pass.
    pub detection_probability: Option<BTreeMap<String, Detection>>,
    /// Share of the items of each kind that sensors of this model never detect, however often they
    /// look, 0 to 1. Drawn once per item. By default 0.
    #[serde(default)]
    pub blind_share: BTreeMap<String, f64>,
    /// Share of the items of each kind (outer keys) that look like another kind (inner keys) to
    /// sensors of this model, however often they look, 0 to 1: detected and reported as items of
    /// that kind. Drawn once per item. By default 0.
    #[serde(default)]
    pub lookalike_share: BTreeMap<String, BTreeMap<String, f64>>,
    /// Name of the sensor model: sensors of one model are blind to the same items, and the same items
    /// look like another kind to them, on whichever robot they are. By default, each sensor of each
    /// robot kind is a model of its own.
    pub model: Option<String>,
    /// Probability of each reported kind (inner keys) by the kind of a detected item (outer keys),
    /// that which it looks like, drawn per look. The probabilities of a row must sum to 1; a kind
    /// that is not given is reported as it is.
    #[serde(default)]
    pub confusion: BTreeMap<String, BTreeMap<String, f64>>,
    /// False alarms per second and square metre in view, by the kind of item that they are taken
    /// for.
    #[serde(default)]
    pub false_alarm_rate_per_m2_s: BTreeMap<String, f64>,
    /// Standard deviation of the measured position of a contact, along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Whether obstacles hide items.
    #[serde(default = "yes")]
    pub needs_line_of_sight: bool,
    /// What robots and controllers believe of the sensor where that differs from what it does.
    pub believed: Option<Box<BelievedSpec>>,
}

impl ItemsSpec {
    /// The sensor as robots and controllers believe it to be, of all kinds of items. It is the sensor
    /// itself if nothing else is given.
    pub(crate) fn as_believed<'i>(&self, kinds: impl Iterator<Item = &'i String>) -> Cow<'_, Self> {
        let Some(believed) = &self.believed else {
            return Cow::Borrowed(self);
        };
        let mut sensor = self.as_it_is();
        if !believed.detection_probability.is_empty() {
            let always = kinds.map(|kind| (kind.clone(), Detection::Constant(1.0)));
            let detected = &mut sensor.detection_probability;
            let detected = detected.get_or_insert_with(|| always.collect());
            detected.extend(believed.detection_probability.clone());
        }
        sensor.blind_share.extend(believed.blind_share.clone());
        sensor
            .lookalike_share
            .extend(believed.lookalike_share.clone());
        sensor.confusion.extend(believed.confusion.clone());
        Cow::Owned(sensor)
    }

    /// The sensor, if what it is believed to be were the truth about it.
    pub(crate) fn as_it_is(&self) -> Self {
        Self {
            believed: None,
            ..self.clone()
        }
    }

    /// Whether it detects items of a kind, if only those that look like another kind.
    pub(crate) fn may_detect(&self, kind: &str) -> bool {
        let detects = |kind: &str| {
            let detected = self.detection_probability.as_ref();
            detected.is_none_or(|detected| detected.contains_key(kind))
        };
        let lookalikes = self.lookalike_share.get(kind).into_iter().flatten();
        let mut visible = lookalikes.filter(|(_, share)| **share > 0.0);
        detects(kind) || visible.any(|(other, _)| detects(other))
    }

    /// The key of its model in random streams, if it is the sensor `name` of a kind `owner`.
    pub(crate) fn model_key(&self, owner: &str, name: &str) -> u32 {
        kind_key(&self.model_name(owner, name))
    }

    /// The name of its model. No name that a scenario may give contains a dot.
    pub(crate) fn model_name(&self, owner: &str, name: &str) -> String {
        self.model
            .clone()
            .unwrap_or_else(|| format!("{owner}.{name}"))
    }

    /// The share of the items of each kind that it never detects; empty if it is 0 for all.
    pub(super) fn blind_shares(&self, kinds: &[String]) -> Vec<f64> {
        let share = |kind| self.blind_share.get(kind).copied().unwrap_or(0.0);
        let shares: Vec<f64> = kinds.iter().map(share).collect();
        if shares.iter().all(|share| *share == 0.0) {
            return Vec::new();
        }
        shares
    }

    /// The share of the items of each kind that look like each kind; empty if all look like what they are.
    pub(crate) fn appearances(&self, kinds: &[String]) -> Vec<Vec<f64>> {
        appearances(&self.lookalike_share, kinds)
    }

    /// Mean number of false alarms of a kind per measurement, if no obstacle hides any.
    pub(crate) fn false_alarms_per_measurement(&self, kind: &str, period_s: f64) -> f64 {
        let rate = self.false_alarm_rate_per_m2_s.get(kind).copied();
        rate.unwrap_or(0.0) * Sector::new(&self.sector).area_m2() * period_s
    }
}
