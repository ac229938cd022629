//! A kind of robot, converted for runs.

use super::battery::Battery;
use super::collision::Collision;
use super::drive::Drive;
use super::tools::Tool;
use super::{Layer, RobotSpec};
use crate::goals::kind::capability;
use crate::radio::Radio;
use crate::schedule::Schedule;
use crate::sensors::robots::RobotDetector;
use crate::sensors::sensor_kind::{AmongKinds, Provides, SensorContext};
use crate::sensors::{Sensor, SensorSpec};
use crate::world::items::MARK_TOLERANCE_M;
use base::geometry::{Point, Rectangle};
use base::placement::Placement;
use base::random::{Entity, kind_key};
use brain::behaviours::flock::{self, Sums};
use brain::{ActKind, Body, Brain, Detector, Motion, Other, RandomWords};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What all robots of a kind have in common.
#[derive(Debug, Clone)]
pub(crate) struct Kind {
    pub(crate) name: String,
    /// Its name in random streams: [`kind_key`].
    pub(crate) key: u32,
    pub(crate) count: u32,
    pub(crate) layer: Layer,
    pub(crate) radius_m: f64,
    pub(crate) price: f64,
    pub(crate) mean_time_between_failures_s: Option<f64>,
    pub(crate) failed: Vec<u32>,
    pub(crate) out_of_service: Vec<u32>,
    pub(crate) start: Placement,
    pub(crate) drive: Drive,
    pub(crate) collision: Collision,
    pub(crate) battery: Option<Battery>,
    /// Sorted by name.
    pub(crate) sensors: Vec<Sensor>,
    /// One for each kind of act that its robots can do.
    pub(crate) tools: Vec<Tool>,
    /// Charges of each robot at the start; `None` without a tool that needs them.
    pub(crate) charges: Option<u32>,
    /// Maximum range of its rays; 0 without rays.
    pub(crate) rays_m: f64,
    pub(crate) radio: Option<Radio>,
    /// Power of its radio and all its sensors.
    all_on_w: f64,
    /// When its brain steps.
    pub(crate) schedule: Schedule,
    /// The brain that each robot starts with; clones share what is the same for all.
    pub(crate) brain: Brain,
    /// If its robots only flock, in a world without obstacles.
    pub(crate) flocking: Option<Flocking>,
}

/// How robots that only flock, and detect all others at once and exactly, move.
#[derive(Debug, Clone)]
pub(crate) struct Flocking {
    rule: flock::Ready,
    /// Maximum range at which they detect others.
    pub(crate) reach_m: f64,
    measures_headings: bool,
}

impl Flocking {
    /// Squares of their range and of the separation distance.
    #[inline]
    pub(crate) fn squares(&self) -> [f64; 2] {
        [self.reach_m, self.rule.separation_m()].map(|distance_m| distance_m * distance_m)
    }

    /// The motion setpoint of a flocking robot, given its turn rate.
    #[inline]
    pub(crate) fn motion(&self, turn_rate_rad_s: f64) -> Motion {
        Motion {
            speed_m_s: self.rule.speed_m_s(),
            turn_rate_rad_s,
        }
    }

    /// The turn rate of a robot with the heading `front`, given the sums over its neighbours.
    #[inline]
    pub(crate) fn turn_rate_rad_s(
        &self,
        front: Point,
        sums: &Sums,
        random_words: impl FnOnce() -> RandomWords,
    ) -> f64 {
        let course = if self.measures_headings {
            sums.course
        } else {
            Point::default()
        };
        let sums = Sums { course, ..*sums };
        self.rule.turn_rate_rad_s(front, &sums, random_words)
    }
}

/// What a kind depends on besides its own keys.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KindContext<'a> {
    pub(crate) item_kinds: &'a [String],
    /// The distance from the footprint of a robot on the ground at which an item of each kind may destroy it.
    pub(crate) hazards_m: &'a [Option<f64>],
    pub(crate) robots: &'a BTreeMap<String, RobotSpec>,
    /// Names of all capabilities, sorted.
    pub(crate) capabilities: &'a [String],
    pub(crate) field: Rectangle,
    pub(crate) step_s: f64,
}

impl Kind {
    /// The kind that `spec` describes.
    pub(crate) fn new(name: &str, spec: &RobotSpec, context: &KindContext) -> Self {
        let KindContext {
            item_kinds, step_s, ..
        } = *context;
        let sensors = mounted(name, spec, context);
        let sensors = sensors.map(|(spec, context)| Sensor::new(spec, &context, step_s));
        let sensors: Vec<Sensor> = sensors.collect();
        let tools = spec.tools.ready(step_s);
        let schedule = Schedule::new(spec.brain.rate_hz, step_s);
        let drive = Drive::new(&spec.drive, spec.radius_m, step_s);
        let mut body = Body {
            radius_m: spec.radius_m,
            max_speed_m_s: drive.max_speed_m_s,
            max_reverse_speed_m_s: drive.max_reverse_speed_m_s,
            max_acceleration_m_s2: drive.max_acceleration_m_s2,
            max_turn_rate_rad_s: drive.max_turn_rate_rad_s,
            period_s: schedule.period_s(step_s),
            sensors: sensors.iter().map(|sensor| sensor.name.clone()).collect(),
            rings: Vec::new(),
            detectors: detectors(name, spec, context),
            position_noise_m: 0.0,
            position_drift_m: 0.0,
            position_drift_s: 0.0,
            heading_noise_rad: 0.0,
            neighbour_noise_m: 0.0,
            item_kinds: item_kinds.to_vec(),
            hazards_m: hazards_m(spec.layer, context),
            others: others(spec.layer, context),
            capabilities: capabilities(spec, context.capabilities),
            tools: tools.iter().map(|tool| tool.known).collect(),
            field: Some(context.field),
        };
        for (sensor, context) in mounted(name, spec, context) {
            sensor.measures.extend_body(&context, &mut body);
        }
        let mut kind = Self {
            all_on_w: 0.0,
            name: name.to_owned(),
            key: kind_key(name),
            count: spec.count,
            layer: spec.layer,
            radius_m: spec.radius_m,
            price: spec.price,
            mean_time_between_failures_s: spec.mean_time_between_failures_s,
            failed: spec.failed.clone(),
            out_of_service: spec.out_of_service.clone(),
            start: spec.start.clone(),
            drive,
            collision: Collision::new(&spec.collision, step_s),
            battery: spec
                .battery
                .as_ref()
                .map(|battery| Battery::new(battery, (spec.mass_kg, spec.payload_kg))),
            tools,
            charges: spec.tools.neutralise.as_ref().map(|tool| tool.charges),
            rays_m: reach_m(&sensors, Provides::Distances),
            sensors,
            radio: spec.radio.as_ref().map(|radio| Radio::new(radio, step_s)),
            schedule,
            brain: Brain::new(Arc::new(spec.brain.clone()), Arc::new(body)),
            flocking: None,
        };
        kind.all_on_w = kind.some_on_w(0);
        kind
    }

    /// The flocking rule of its robots in a world without obstacles, if they do nothing else, and
    /// have the sensors for it and no others.
    pub(crate) fn as_flock(&self) -> Option<Flocking> {
        let rule = self.brain.flock()?;
        let [sensor] = self.sensors.as_slice() else {
            return None;
        };
        let detector = RobotDetector::of(&sensor.measure)?;
        let is_plain = self.drive.errors.is_none()
            && self.schedule.is_every_step()
            && self.radio.is_none()
            && sensor.is_immediate()
            && sensor.dropout_probability == 0.0
            && detector.is_exact();
        is_plain.then(|| Flocking {
            rule: rule.clone(),
            reach_m: sensor.reach_m(Provides::Robots),
            measures_headings: detector.measures_headings(),
        })
    }

    /// Whether anything that its robots measure can wait for their brains.
    pub(crate) fn needs_backlog(&self) -> bool {
        let is_late = |sensor: &Sensor| !sensor.is_immediate();
        !self.schedule.is_every_step() || self.sensors.iter().any(is_late)
    }

    /// The key of one of its robots in random streams.
    pub(crate) fn entity(&self, index: u32) -> Entity {
        Entity {
            kind: self.key,
            index,
        }
    }

    /// Power of its radio and of its sensors, except the sensors whose bits are set in `off`.
    #[inline]
    pub(crate) fn sensing_w(&self, off: u32) -> f64 {
        if off == 0 {
            self.all_on_w
        } else {
            self.some_on_w(off)
        }
    }

    fn some_on_w(&self, off: u32) -> f64 {
        let sensors = self.sensors.iter().enumerate();
        let on = sensors.filter(|(number, _)| off & (1 << number) == 0);
        let radio_w = self.radio.map_or(0.0, |radio| radio.power_w);
        radio_w + on.map(|(_, sensor)| sensor.power_w).sum::<f64>()
    }

    /// The numbers of its range sensors among its sensors, in the order of the scans of percepts.
    pub(crate) fn ring_sensors(&self) -> impl Iterator<Item = usize> {
        let sensors = self.sensors.iter().enumerate();
        let rings = sensors.filter(|(_, sensor)| sensor.facts.is_ring);
        rings.map(|(number, _)| number)
    }

    /// Maximum distance from its centre at the start of a step at which it can touch something in
    /// that step, where it drives at its maximum speed for `longest_s`.
    pub(crate) fn touch_m(&self, longest_s: f64) -> f64 {
        self.radius_m + 1.01 * self.drive.fastest_m_s() * longest_s + 1e-3
    }

    /// Maximum distance at which it detects robots or communicates with them.
    pub(crate) fn robots_reach_m(&self) -> f64 {
        let detected_m = reach_m(&self.sensors, Provides::Robots);
        self.radio
            .map_or(detected_m, |radio| radio.range_m.max(detected_m))
    }

    /// Maximum distance between the place that its robots name and an item that they act on.
    pub(crate) fn acts_reach_m(&self) -> f64 {
        let reaches = self.tools.iter().map(|tool| match tool.known.act {
            ActKind::Isolate | ActKind::Neutralise => tool.known.reach_m,
            ActKind::Mark | ActKind::Confirm | ActKind::Reject => MARK_TOLERANCE_M,
            ActKind::DeclareClear | ActKind::GiveUp => 0.0,
        });
        reaches.fold(0.0, f64::max)
    }

    /// Maximum distance at which it detects items.
    pub(crate) fn items_reach_m(&self) -> f64 {
        reach_m(&self.sensors, Provides::Items)
    }
}

/// Maximum range at which sensors provide something; 0 without any that does.
fn reach_m(sensors: &[Sensor], what: Provides) -> f64 {
    let ranges_m = sensors.iter().map(|sensor| sensor.reach_m(what));
    ranges_m.fold(0.0, f64::max)
}

/// The dangers of items for robots in a layer: in the air, there are none.
fn hazards_m(layer: Layer, context: &KindContext) -> Vec<Option<f64>> {
    let has_any = context.hazards_m.iter().any(Option::is_some);
    if layer == Layer::Ground && has_any {
        context.hazards_m.to_vec()
    } else {
        Vec::new()
    }
}

fn others(layer: Layer, context: &KindContext) -> Vec<Other> {
    let other = |(name, spec): (&String, &RobotSpec)| Other {
        radius_m: spec.radius_m,
        max_acceleration_m_s2: spec.drive.max_acceleration_m_s2.unwrap_or(f64::INFINITY),
        is_in_the_way: spec.layer == layer,
        detectors: detectors(name, spec, context),
    };
    context.robots.iter().map(other).collect()
}

/// The numbers of its capabilities among all of these.
fn capabilities(spec: &RobotSpec, all: &[String]) -> Vec<u8> {
    let mut numbers: Vec<u8> = spec
        .capabilities
        .iter()
        .map(|name| capability(name, all))
        .collect();
    numbers.sort_unstable();
    numbers
}

/// The item detectors of a robot kind, as all brains know them.
fn detectors(owner: &str, spec: &RobotSpec, context: &KindContext) -> Vec<Detector> {
    let sensors = mounted(owner, spec, context);
    let detectors = sensors.filter_map(|(sensor, context)| sensor.measures.detector(&context));
    detectors.collect()
}

/// The sensors of a robot kind, in their order, each with what it depends on.
fn mounted<'a>(
    owner: &'a str,
    spec: &'a RobotSpec,
    context: &KindContext<'a>,
) -> impl Iterator<Item = (&'a SensorSpec, SensorContext<'a>)> {
    let KindContext {
        item_kinds, step_s, ..
    } = *context;
    (0..)
        .zip(&spec.sensors)
        .map(move |(number, (name, sensor))| {
            let context = sensor.context(number, (owner, name), item_kinds, step_s);
            (sensor, context)
        })
}
