//! The sensor manager at work: the measurements of one robot in one step.
//!
//! A sensor that measures in each step and has no latency writes directly into the percept if the
//! brain steps now. Everything else goes into the backlog of the robot, from which the brain gets
//! it when it steps.

use super::view::View;
use crate::run::agent::Agent;
use crate::sensors::backlog::{Backlog, age_s};
use crate::sensors::items::ItemDetector;
use crate::sensors::pending::Pending;
use crate::sensors::range::Room;
use crate::sensors::rays::Near;
use crate::sensors::robots::RobotDetector;
use crate::sensors::sensor_frame::{NoisePurpose, SensorFrame};
use crate::sensors::{Measure, Sensor};
use base::geometry::{Disc, Point};
use base::noise::{normal_pair, share};
use base::trig::wrapped;
use brain::{self, Contact, Neighbour, Percept, Reading};

/// Buffers for measurements, and what the judge counts of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Detections {
    /// With what the rays of the robot can meet, once one of its rings has measured.
    room: Room,
    is_near_known: bool,
    values: Vec<f64>,
    /// Robots that may be detected.
    others: Vec<u32>,
    /// Items that robots detected, in the order of the robots.
    pub(crate) sightings: Vec<u32>,
    /// False alarms in the percepts of robots.
    pub(crate) false_alarms: u64,
}

impl Detections {
    pub(crate) fn clear(&mut self) {
        self.sightings.clear();
        self.false_alarms = 0;
    }

    /// Notes the item of a contact in a percept, or none for a false alarm.
    pub(crate) fn note(&mut self, item: Option<u32>) {
        match item {
            Some(item) => self.sightings.push(item),
            None => self.false_alarms += 1,
        }
    }
}

/// One measurement.
struct Measurement<'a> {
    view: &'a View<'a>,
    robot: usize,
    sensor: &'a Sensor,
    frame: SensorFrame<'a>,
    /// Index of the sensor on the robot, and of a ring among its rings.
    number: usize,
    ring: usize,
}

/// Takes the measurements of a robot in this step; `percept` is given if its brain steps.
pub(crate) fn sense(
    view: &View,
    robot: usize,
    agent: &mut Agent,
    detections: &mut Detections,
    mut percept: Option<&mut Percept>,
) {
    let kind = view.kind(robot);
    let mut ring = 0;
    detections.is_near_known = false;
    if percept.is_none() {
        agent.forget(view.tick);
    }
    for (number, sensor) in kind.sensors.iter().enumerate() {
        let is_of_use = percept.is_some() || sensor.outlasts_a_step();
        let beat = sensor
            .schedule
            .beat(view.tick)
            .filter(|_| is_of_use && agent.is_on(number));
        if let Some(beat) = beat {
            let measurement = Measurement {
                view,
                robot,
                sensor,
                frame: view.sensor_frame(robot, number, beat),
                number,
                ring,
            };
            measurement.take(agent, detections, percept.as_deref_mut());
        }
        ring += usize::from(matches!(sensor.measure, Measure::Range(_)));
    }
    if let (Some(percept), Some(backlog)) = (percept, &mut agent.backlog) {
        tell_kept(view, robot, backlog, detections, percept);
    }
}

/// Moves delayed measurements into the percept.
fn tell_kept(
    view: &View,
    robot: usize,
    backlog: &mut Backlog,
    detections: &mut Detections,
    percept: &mut Percept,
) {
    let (now, step_s) = (view.tick, view.scenario.step_s);
    let mut ring = 0;
    for (number, sensor) in view.kind(robot).sensors.iter().enumerate() {
        if let Some((taken, values)) = backlog.newest(number, sensor.latency_steps, now) {
            detections.values.clear();
            detections.values.extend_from_slice(values);
            put(
                percept,
                &sensor.measure,
                ring,
                age_s(taken, now, step_s),
                &mut detections.values,
            );
        }
        ring += usize::from(matches!(sensor.measure, Measure::Range(_)));
    }
    backlog.deliver(now, step_s, percept, |item| detections.note(item));
}

/// Writes a measurement into the percept.
fn put(percept: &mut Percept, measure: &Measure, ring: usize, age_s: f64, values: &mut Vec<f64>) {
    match (measure, values.as_slice()) {
        (Measure::Range(_), _) => {
            let scan = &mut percept.scans[ring];
            scan.age_s = Some(age_s);
            std::mem::swap(&mut scan.ranges_m, values);
        }
        (Measure::Position { .. }, &[x, y]) => {
            let value = Point { x, y };
            percept.position = Some(Reading { value, age_s });
        }
        (Measure::Heading { .. }, &[value]) => {
            percept.heading_rad = Some(Reading { value, age_s });
        }
        _ => {}
    }
}

impl Measurement<'_> {
    #[inline]
    fn take(&self, agent: &mut Agent, detections: &mut Detections, percept: Option<&mut Percept>) {
        let sensor = self.sensor;
        let is_lost = sensor.dropout_probability > 0.0
            && share(self.frame.words(NoisePurpose::DropOut, 0)[0]) < sensor.dropout_probability;
        match &sensor.measure {
            Measure::Items(_) | Measure::Robots(_) if is_lost => {}
            Measure::Items(detector) => self.find_items(detector, agent, detections, percept),
            Measure::Robots(detector) => {
                self.find_robots(detector, agent, &mut detections.others, percept);
            }
            value => {
                self.measure(value, detections);
                self.tell_value(is_lost, agent, detections, percept);
            }
        }
    }

    /// Measures values into `detections`.
    #[inline]
    fn measure(&self, measure: &Measure, detections: &mut Detections) {
        let frame = &self.frame;
        if !matches!(measure, Measure::Range(_)) {
            detections.values.clear();
        }
        match measure {
            Measure::Range(ring) => {
                if !detections.is_near_known {
                    gather(self.view, self.robot, &mut detections.room.near);
                    detections.is_near_known = true;
                }
                ring.measure(frame, &mut detections.room, &mut detections.values);
            }
            Measure::Position { noise_m } => {
                let [x, y] = deviations(frame).map(|deviation| deviation * noise_m);
                detections.values.extend([frame.at.x + x, frame.at.y + y]);
            }
            Measure::Heading { noise_rad } => {
                let heading_rad = self.view.orientations[self.robot].heading_rad;
                detections
                    .values
                    .push(wrapped(heading_rad + noise_rad * deviations(frame)[0]));
            }
            Measure::Items(_) | Measure::Robots(_) => {}
        }
    }

    #[inline]
    fn tell_value(
        &self,
        is_lost: bool,
        agent: &mut Agent,
        detections: &mut Detections,
        percept: Option<&mut Percept>,
    ) {
        if self.sensor.is_immediate() {
            if let Some(percept) = percept.filter(|_| !is_lost) {
                put(
                    percept,
                    &self.sensor.measure,
                    self.ring,
                    0.0,
                    &mut detections.values,
                );
            }
        } else if let Some(backlog) = &mut agent.backlog {
            let taken = (!is_lost).then_some(self.view.tick);
            let kept = backlog.keep(self.number, self.frame.measurement, taken);
            std::mem::swap(kept, &mut detections.values);
        }
    }

    fn find_items(
        &self,
        detector: &ItemDetector,
        agent: &mut Agent,
        detections: &mut Detections,
        percept: Option<&mut Percept>,
    ) {
        let scenario = self.view.scenario;
        let is_there = |place| scenario.torus.is_some() || scenario.world.contains(place);
        let is_immediate = self.sensor.latency_steps == 0;
        let mut percept = percept.filter(|_| is_immediate);
        let observation = brain::Observation {
            sensor: self.place(),
            age_s: 0.0,
        };
        match percept.as_deref_mut() {
            Some(percept) => percept.observations.push(observation),
            None => agent.keep_observation(self.late(observation)),
        }
        detector.measure(&self.frame, self.view.items, |way, kind, item| {
            // Beyond the border there are no false alarms.
            if item.is_none() && !is_there(self.frame.world_of(way)) {
                return;
            }
            let (range_m, bearing_rad) = polar(way);
            let contact = Contact {
                kind,
                sensor: observation.sensor,
                range_m,
                bearing_rad,
                age_s: 0.0,
            };
            match percept.as_deref_mut() {
                Some(percept) => {
                    percept.contacts.push(contact);
                    detections.note(item);
                }
                None => agent.wait_contact(self.late((contact, item))),
            }
        });
    }

    fn find_robots(
        &self,
        detector: &RobotDetector,
        agent: &mut Agent,
        others: &mut Vec<u32>,
        percept: Option<&mut Percept>,
    ) {
        let view = self.view;
        let is_immediate = self.sensor.latency_steps == 0;
        let mut percept = percept.filter(|_| is_immediate);
        let about = view
            .neighbours
            .about(self.frame.at, detector.sector.range_m);
        others.clear();
        others.extend(about.filter(|other| *other as usize != self.robot));
        // Lists of near robots have no particular order.
        others.sort_unstable();
        let is_clear = self.is_clear(detector, others);
        for other in others.iter() {
            let other = *other as usize;
            let layers = [self.robot, other].map(|robot| view.kind(robot).layer);
            let frame = SensorFrame {
                stands: view.scenario.hiding(layers),
                is_clear,
                ..self.frame
            };
            let (place, entity) = (
                view.scenario.image(self.frame.at, view.discs[other].centre),
                view.scenario.entity(view.ids[other]),
            );
            let Some(way) = detector.measure(&frame, place, entity) else {
                continue;
            };
            let [own_rad, its_rad] =
                [self.robot, other].map(|robot| view.orientations[robot].heading_rad);
            let (range_m, bearing_rad) = polar(way);
            let neighbour = Neighbour {
                range_m,
                bearing_rad,
                course_rad: detector.course_rad(&frame, its_rad - own_rad, entity),
                age_s: 0.0,
                id: view.ids[other],
            };
            match percept.as_deref_mut() {
                Some(percept) => percept.neighbours.push(neighbour),
                None => agent.wait_neighbour(self.late(neighbour)),
            }
        }
    }

    /// Whether static geometry hides none of the others.
    fn is_clear(&self, detector: &RobotDetector, others: &[u32]) -> bool {
        let scenario = self.view.scenario;
        let Some(first) = others.first().filter(|_| scenario.is_one_layer()) else {
            return false;
        };
        let layers = [self.robot, *first as usize].map(|robot| self.view.kind(robot).layer);
        let stands = scenario.hiding(layers);
        stands.is_clear(self.frame.at, detector.sector.range_m)
    }

    /// Index of the sensor, as brains count it.
    fn place(&self) -> u16 {
        #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
        let place = self.number as u16;
        place
    }

    fn late<T>(&self, what: T) -> Pending<T> {
        let taken = self.view.tick;
        Pending {
            taken,
            due: taken + self.sensor.latency_steps,
            what,
        }
    }
}

fn polar(way: Point) -> (f64, f64) {
    (way.length(), libm::atan2(way.y, way.x))
}

/// Two standard normal deviates for the error of a measurement.
fn deviations(frame: &SensorFrame) -> [f64; 2] {
    let [a, b, ..] = frame.words(NoisePurpose::Error, 0);
    normal_pair([a, b])
}

/// What the rays of a robot can meet.
#[inline]
pub(crate) fn gather<'v>(view: &View<'v>, robot: usize, near: &mut Near) {
    let kind = view.kind(robot);
    let stands = view.scenario.seen(kind.layer);
    let vicinity = view.neighbours.of(robot);
    let at = view.discs[robot].centre;
    near.begin(at, kind.rays_m);
    let bodies = vicinity.robots.iter();
    let bodies = bodies.map(|other| {
        let body = view.discs[*other as usize];
        Disc {
            centre: view.scenario.image(at, body.centre),
            ..body
        }
    });
    // An external body may be where another robot is; simulated ones never are.
    if view.has_external_bodies {
        near.take_overlapping(bodies);
    } else {
        near.take_apart(bodies);
    }
    let discs = |numbers: &'v [u32]| numbers.iter().map(|number| *stands.disc(*number));
    near.take_apart(discs(vicinity.discs_apart));
    near.take_overlapping(discs(vicinity.discs_overlapping));
    near.take_walls(vicinity.walls.iter().map(|number| stands.wall(*number)));
}
