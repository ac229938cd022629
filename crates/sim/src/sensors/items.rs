//! Item detector.

use super::blindness::Blindness;
use super::confusion::{Confusion, matrix};
use super::sector::{Sector, SectorSpec};
use super::sensor_frame::{NoisePurpose, SensorFrame, blurred};
use crate::poisson::Poisson;
use crate::world::items::Items;
use base::geometry::Point;
use base::noise::share;
use base::random::{Entity, kind_key};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
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
    /// Name of the sensor model: sensors of one model are blind to the same items, on whichever
    /// robot they are. By default, each sensor of each robot kind is a model of its own.
    pub model: Option<String>,
    /// Probability of each reported kind (inner keys) by the true kind of a detected item (outer
    /// keys), drawn per look. The probabilities of a true kind must sum to 1; a kind that is not
    /// given is reported as it is.
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
}

/// A brain gets a bell curve as this number of straight pieces.
const CURVE_PARTS: u32 = 16;

/// Probability of detection per measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Detection {
    /// The same at any distance in range.
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// Pairs of distance (metres) and probability, by increasing distance; linear in between.
    Table(Vec<[f64; 2]>),
    /// A bell curve: `peak` at distance 0, half of that at `half_range_m`.
    Curve {
        /// Probability at distance 0.
        #[schemars(range(min = 0.0, max = 1.0))]
        peak: f64,
        /// Distance at which the probability is half the peak, in metres.
        #[schemars(range(min = 0.001, max = 10_000.0))]
        half_range_m: f64,
    },
}

impl Detection {
    /// Probability of detection at a distance.
    pub(super) fn probability(&self, distance_m: f64) -> f64 {
        match self {
            Self::Constant(probability) => *probability,
            Self::Table(pairs) => between(pairs, distance_m),
            Self::Curve { peak, half_range_m } => {
                let halves = distance_m / half_range_m;
                peak * libm::exp2(-halves * halves)
            }
        }
    }
}

impl Detection {
    /// Pairs of distance and probability, linear in between, up to `range_m`.
    fn pairs(&self, range_m: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Constant(probability) => vec![[0.0, *probability]],
            Self::Table(pairs) => pairs.clone(),
            Self::Curve { .. } => (0..=CURVE_PARTS)
                .map(|part| range_m * f64::from(part) / f64::from(CURVE_PARTS))
                .map(|at| [at, self.probability(at)])
                .collect(),
        }
    }
}

/// The value at `x`, linear between pairs; beyond the ends, that of the end.
fn between(pairs: &[[f64; 2]], x: f64) -> f64 {
    let next = pairs.partition_point(|[at, _]| *at <= x);
    match (next.checked_sub(1).map(|last| pairs[last]), pairs.get(next)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some([_, y]), None) | (None, Some(&[_, y])) => y,
        (None, None) => 0.0,
    }
}

pub(super) fn yes() -> bool {
    true
}

impl ItemsSpec {
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

    /// What brains know of it: the sensor with this number and model key, which measures every
    /// `period_s`.
    pub(crate) fn detector(
        &self,
        (sensor, model): (u16, u32),
        item_kinds: &[String],
        period_s: f64,
    ) -> brain::Detector {
        let sector = &self.sector;
        let always = Detection::Constant(1.0);
        let detection_probability =
            item_kinds
                .iter()
                .map(|kind| match &self.detection_probability {
                    None => always.pairs(sector.range_m),
                    Some(detection_probability) => detection_probability
                        .get(kind)
                        .map_or_else(Vec::new, |detection| detection.pairs(sector.range_m)),
                });
        let rates = item_kinds
            .iter()
            .map(|kind| self.false_alarm_rate_per_m2_s.get(kind));
        let blind_share = self.blind_shares(item_kinds);
        let confusion = if self.confusion.is_empty() {
            Vec::new()
        } else {
            matrix(&self.confusion, item_kinds)
        };
        brain::Detector {
            sensor,
            // Without blind items, it does not matter.
            model: if blind_share.is_empty() { 0 } else { model },
            blind_share,
            confusion,
            range_m: sector.range_m,
            width_rad: sector.fov_deg.to_radians(),
            facing_rad: sector.facing_deg.to_radians(),
            detection_probability: detection_probability.collect(),
            false_alarms_per_m2: rates
                .map(|rate| rate.copied().unwrap_or(0.0) * period_s)
                .collect(),
            noise_m: self.noise_m,
            needs_line_of_sight: self.needs_line_of_sight,
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
        for (place, number) in items.near(frame.at, self.sector.range_m) {
            let way = frame.own(*place);
            let kind = items.kind(*number);
            let Some(detection) = &self.detection_probability[usize::from(kind)] else {
                continue;
            };
            if !self.sector.holds(way) || self.is_hidden(frame, *place) {
                continue;
            }
            let thing = items.thing(*number);
            let words = frame.words_of(NoisePurpose::Thing, thing);
            let is_detected = share(words[0]) < detection.probability(way.length());
            if is_detected
                && !blind
                    .as_ref()
                    .is_some_and(|blind| blind.contains(kind, thing))
            {
                let confusion = self.confusion.as_ref();
                let reported = confusion.map_or(kind, |each| each.reported(kind, words[3]));
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
mod tests {
    use super::*;

    #[test]
    fn a_detection_table_is_linear_between_its_pairs_and_flat_beyond() {
        let table = Detection::Table(vec![[1.0, 0.9], [2.0, 0.5], [4.0, 0.1]]);
        for (distance_m, expected) in [
            (0.0, 0.9),
            (1.0, 0.9),
            (1.5, 0.7),
            (2.0, 0.5),
            (3.0, 0.3),
            (4.0, 0.1),
            (99.0, 0.1),
        ] {
            let probability = table.probability(distance_m);
            assert!(
                (probability - expected).abs() < 1e-12,
                "{distance_m}: {probability}"
            );
        }
        let one = Detection::Table(vec![[1.0, 0.4]]);
        assert_eq!([0.0, 1.0, 2.0].map(|at| one.probability(at)), [0.4; 3]);
    }

    #[test]
    fn a_detection_curve_is_a_bell_curve_with_half_its_peak_at_the_half_range() {
        let curve = Detection::Curve {
            peak: 0.8,
            half_range_m: 1.5,
        };
        for (distance_m, expected) in [(0.0, 0.8), (1.5, 0.4), (3.0, 0.05), (4.5, 0.8 / 512.0)] {
            assert!(
                (curve.probability(distance_m) - expected).abs() < 1e-12,
                "{distance_m}"
            );
        }
    }

    #[test]
    fn a_constant_detection_does_not_depend_on_the_distance() {
        let constant = Detection::Constant(0.3);
        assert_eq!([0.0, 7.0].map(|at| constant.probability(at)), [0.3; 2]);
    }
}
