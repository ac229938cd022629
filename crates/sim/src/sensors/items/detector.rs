//! A measurement of an item detector.

use super::spec::ItemsSpec;
use crate::poisson::Poisson;
use crate::sensors::blindness::Blindness;
use crate::sensors::buffers::Buffers;
use crate::sensors::confusion::Confusion;
use crate::sensors::detection::Detection;
use crate::sensors::detection_sink::DetectionSink;
use crate::sensors::lookalikes::Lookalikes;
use crate::sensors::outline::{BlockedBy, Outline};
use crate::sensors::scene::Scene;
use crate::sensors::sector::Sector;
use crate::sensors::sensor_frame::{NoisePurpose, SensorFrame, blurred, polar};
use crate::sensors::sensor_kind::{Instrument, SensorContext};
use crate::world::items::Items;
use base::geometry::Point;
use base::noise::share;
use base::random::{Entity, kind_key};
use brain::{Contact, Observation};

/// A detector, converted for measurements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ItemDetector {
    sector: Sector,
    /// By the kind of item; `None` is never detected.
    detection_probability: Vec<Option<Detection>>,
    blindness: Option<Blindness>,
    lookalikes: Option<Lookalikes>,
    confusion: Option<Confusion>,
    /// By the kind that they are taken for; only those with a rate above 0.
    false_alarms: Vec<FalseAlarm>,
    noise_m: f64,
    needs_line_of_sight: bool,
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

impl Instrument for ItemDetector {
    const DETECTS: bool = true;

    fn measure(
        &self,
        frame: &SensorFrame,
        scene: &impl Scene,
        _buffers: &mut Buffers,
        sink: &mut impl DetectionSink,
    ) {
        #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
        let sensor = frame.sensor as u16;
        sink.add_observation(Observation { sensor, age_s: 0.0 });
        self.contacts(frame, scene.items(), |way, kind, item| {
            // Beyond the border there are no false alarms.
            if item.is_none() && !scene.contains(frame.world_of(way)) {
                return;
            }
            let (range_m, bearing_rad) = polar(way);
            let contact = Contact {
                kind,
                sensor,
                range_m,
                bearing_rad,
                age_s: 0.0,
            };
            sink.add_contact(contact, item);
        });
    }

    fn outline(&self) -> Option<Outline> {
        let Sector {
            range_m,
            width_rad,
            facing_rad,
            ..
        } = self.sector;
        Some(Outline {
            range_m,
            width_rad,
            facing_rad,
            blocked_by: if self.needs_line_of_sight {
                BlockedBy::Geometry
            } else {
                BlockedBy::Nothing
            },
        })
    }
}

impl ItemDetector {
    pub(super) fn new(spec: &ItemsSpec, context: &SensorContext) -> Self {
        let kinds = context.item_kinds;
        let model = spec.model_key(context.owner, context.name);
        let detection = |kind: &String| match &spec.detection_probability {
            None => Some(Detection::Constant(1.0)),
            Some(detection_probability) => detection_probability.get(kind).cloned(),
        };
        let false_alarm = |(number, kind): (u16, &String)| {
            let mean = spec.false_alarms_per_measurement(kind, context.period_s);
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
    fn contacts(
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
