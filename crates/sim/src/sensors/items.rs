//! Item detector.

use super::believed::BelievedSpec;
use super::blindness::Blindness;
use super::confusion::{Confusion, matrix};
use super::detection::Detection;
use super::lookalikes::{Lookalikes, appearances};
use super::sector::{Sector, SectorSpec};
use super::sensor_frame::{NoisePurpose, SensorFrame, blurred};
use crate::poisson::Poisson;
use crate::world::items::Items;
use base::geometry::Point;
use base::noise::share;
use base::random::{Entity, kind_key};
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

pub(super) fn yes() -> bool {
    true
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
    fn blind_shares(&self, kinds: &[String]) -> Vec<f64> {
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

    /// What brains believe of it: the sensor with this number and model key, which measures every
    /// `period_s`.
    pub(crate) fn detector(
        &self,
        (sensor, model): (u16, u32),
        item_kinds: &[String],
        period_s: f64,
    ) -> brain::Detector {
        let believed = self.as_believed(item_kinds.iter());
        let sector = &believed.sector;
        let always = Detection::Constant(1.0);
        let detection_probability =
            item_kinds
                .iter()
                .map(|kind| match &believed.detection_probability {
                    None => always.pairs(sector.range_m),
                    Some(detection_probability) => detection_probability
                        .get(kind)
                        .map_or_else(Vec::new, |detection| detection.pairs(sector.range_m)),
                });
        let rates = item_kinds
            .iter()
            .map(|kind| believed.false_alarm_rate_per_m2_s.get(kind));
        let blind_share = believed.blind_shares(item_kinds);
        let lookalike_share = believed.appearances(item_kinds);
        let confusion = if believed.confusion.is_empty() {
            Vec::new()
        } else {
            matrix(&believed.confusion, item_kinds)
        };
        // Otherwise it does not matter.
        let is_of_model = !blind_share.is_empty() || !lookalike_share.is_empty();
        brain::Detector {
            sensor,
            model: if is_of_model { model } else { 0 },
            blind_share,
            lookalike_share,
            confusion,
            range_m: sector.range_m,
            width_rad: sector.fov_deg.to_radians(),
            facing_rad: sector.facing_deg.to_radians(),
            detection_probability: detection_probability.collect(),
            false_alarms_per_m2: rates
                .map(|rate| rate.copied().unwrap_or(0.0) * period_s)
                .collect(),
            noise_m: believed.noise_m,
            needs_line_of_sight: believed.needs_line_of_sight,
        }
    }

    /// Mean number of false alarms of a kind per measurement, if no obstacle hides any.
    pub(crate) fn false_alarms_per_measurement(&self, kind: &str, period_s: f64) -> f64 {
        let rate = self.false_alarm_rate_per_m2_s.get(kind).copied();
        rate.unwrap_or(0.0) * Sector::new(&self.sector).area_m2() * period_s
    }
}

/// A detector, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ItemDetector {
    pub(crate) sector: Sector,
    /// By the kind of item; `None` is never detected.
    detection_probability: Vec<Option<Detection>>,
    blindness: Option<Blindness>,
    lookalikes: Option<Lookalikes>,
    confusion: Option<Confusion>,
    /// By the kind that they are taken for; only those with a rate above 0.
    false_alarms: Vec<FalseAlarm>,
    noise_m: f64,
    pub(crate) needs_line_of_sight: bool,
}

/// False alarms that are taken for one kind of item.
#[derive(Debug, Clone, PartialEq)]
struct FalseAlarm {
    kind: u16,
    /// Key of the kind, in random streams.
    key: u32,
    /// Distribution of their number per measurement.
    count: Poisson,
}

impl ItemDetector {
    /// For a model key, `kinds` of items, in their order, and a measurement every `period_s`.
    pub(crate) fn new(spec: &ItemsSpec, model: u32, kinds: &[String], period_s: f64) -> Self {
        let detection = |kind: &String| match &spec.detection_probability {
            None => Some(Detection::Constant(1.0)),
            Some(detection_probability) => detection_probability.get(kind).cloned(),
        };
        let false_alarm = |(number, kind): (u16, &String)| {
            let mean = spec.false_alarms_per_measurement(kind, period_s);
            (mean > 0.0).then(|| FalseAlarm {
                kind: number,
                key: kind_key(kind),
                count: Poisson::new(mean),
            })
        };
        Self {
            sector: Sector::new(&spec.sector),
            detection_probability: kinds.iter().map(detection).collect(),
            blindness: Blindness::new(model, spec.blind_shares(kinds)),
            lookalikes: Lookalikes::new(model, &spec.lookalike_share, kinds),
            confusion: (!spec.confusion.is_empty()).then(|| Confusion::new(&spec.confusion, kinds)),
            false_alarms: (0..).zip(kinds).filter_map(false_alarm).collect(),
            noise_m: spec.noise_m,
            needs_line_of_sight: spec.needs_line_of_sight,
        }
    }

    /// The contacts of one measurement, each with its item, or none for a false alarm.
    pub(crate) fn measure(
        &self,
        frame: &SensorFrame,
        items: &Items,
        mut give: impl FnMut(Point, u16, Option<u32>),
    ) {
        let blindness = self.blindness.as_ref();
        let blind = blindness.map(|blindness| blindness.in_run(items.run()));
        let lookalikes = self.lookalikes.as_ref();
        let appearance = lookalikes.map(|lookalikes| lookalikes.in_run(items.run()));
        for (place, number) in items.near(frame.at, self.sector.range_m) {
            let way = frame.own(*place);
            let kind = items.kind(*number);
            let thing = items.thing(*number);
            let seen = appearance
                .as_ref()
                .map_or(kind, |each| each.of(kind, thing));
            let Some(detection) = &self.detection_probability[usize::from(seen)] else {
                continue;
            };
            if !self.sector.holds(way) || self.is_hidden(frame, *place) {
                continue;
            }
            let words = frame.words_of(NoisePurpose::Thing, thing);
            let is_detected = share(words[0]) < detection.probability(way.length());
            if is_detected
                && !blind
                    .as_ref()
                    .is_some_and(|blind| blind.contains(kind, thing))
            {
                let confusion = self.confusion.as_ref();
                let reported = confusion.map_or(seen, |each| each.reported(seen, words[3]));
                give(blurred(way, self.noise_m, words), reported, Some(*number));
            }
        }
        for false_alarm in &self.false_alarms {
            self.false_contacts(frame, false_alarm, &mut give);
        }
    }

    fn false_contacts(
        &self,
        frame: &SensorFrame,
        FalseAlarm { kind, key, count }: &FalseAlarm,
        give: &mut impl FnMut(Point, u16, Option<u32>),
    ) {
        let draw = |index| frame.words_of(NoisePurpose::FalseAlarm, Entity { kind: *key, index });
        let count = count.draw(share(draw(0)[0]));
        for number in 1..=count {
            let words = draw(number);
            let way = self.sector.place([share(words[0]), share(words[1])]);
            if !self.is_hidden(frame, frame.world_of(way)) {
                give(way, *kind, None);
            }
        }
    }

    fn is_hidden(&self, frame: &SensorFrame, place: Point) -> bool {
        self.needs_line_of_sight && !frame.sees(place)
    }
}

#[cfg(test)]
mod tests;
