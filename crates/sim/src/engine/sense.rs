//! The sensor manager at work: the looks of one robot in one step.
//!
//! A sensor that looks in each step and has no latency tells at once: its look goes into the
//! percept if the brain steps now. Everything else goes into the robot's backlog, from which the
//! brain is told when it steps.

use super::mind::{Backlog, Mind, age_s};
use super::view::View;
use super::waiting::Late;
use crate::sensing::eye::{Eye, Use};
use crate::sensing::items::ItemDetector;
use crate::sensing::range::Room;
use crate::sensing::rays::Near;
use crate::sensing::robots::RobotDetector;
use crate::sensing::{Measure, Sensor};
use base::geometry::{Disc, Point};
use base::noise::{normal_pair, share};
use base::trig::wrapped;
use brain::{self, Contact, Neighbour, Percept, Reading};

/// What looks need to be taken, and what the judge needs to know of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Senses {
    /// With what rays of the robot can meet, once one of its rings has looked.
    room: Room,
    is_near_known: bool,
    values: Vec<f64>,
    /// Robots that one may see.
    others: Vec<u32>,
    /// Items that robots were told of, in the order of the robots.
    pub(crate) sightings: Vec<u32>,
    /// Contacts that robots were told of and that are of nothing.
    pub(crate) false_alarms: u64,
}

impl Senses {
    pub(crate) fn clear(&mut self) {
        self.sightings.clear();
        self.false_alarms = 0;
    }

    /// Notes what a contact that a robot is told of is of.
    pub(crate) fn note(&mut self, item: Option<u32>) {
        match item {
            Some(item) => self.sightings.push(item),
            None => self.false_alarms += 1,
        }
    }
}

/// One look, and where it belongs.
struct Look<'a> {
    view: &'a View<'a>,
    robot: usize,
    sensor: &'a Sensor,
    eye: Eye<'a>,
    /// Place of the sensor among the robot's, and of a ring among its rings.
    number: usize,
    ring: usize,
}

/// Takes the looks that a robot takes in this step; `percept` is there if its brain steps.
pub(crate) fn sense(
    view: &View,
    robot: usize,
    mind: &mut Mind,
    senses: &mut Senses,
    mut percept: Option<&mut Percept>,
) {
    let kind = view.kind(robot);
    let mut ring = 0;
    senses.is_near_known = false;
    if percept.is_none() {
        mind.forget(view.tick);
    }
    for (number, sensor) in kind.sensors.iter().enumerate() {
        let is_of_use = percept.is_some() || sensor.outlasts_a_step();
        let beat = sensor
            .rhythm
            .beat(view.tick)
            .filter(|_| is_of_use && mind.is_on(number));
        if let Some(beat) = beat {
            let look = Look {
                view,
                robot,
                sensor,
                eye: view.eye(robot, number, beat),
                number,
                ring,
            };
            look.take(mind, senses, percept.as_deref_mut());
        }
        ring += usize::from(matches!(sensor.measure, Measure::Range(_)));
    }
    if let (Some(percept), Some(backlog)) = (percept, &mut mind.backlog) {
        tell_kept(view, robot, backlog, senses, percept);
    }
}

/// Tells of the looks that come late.
fn tell_kept(
    view: &View,
    robot: usize,
    backlog: &mut Backlog,
    senses: &mut Senses,
    percept: &mut Percept,
) {
    let (now, step_s) = (view.tick, view.scenario.step_s);
    let mut ring = 0;
    for (number, sensor) in view.kind(robot).sensors.iter().enumerate() {
        if let Some((taken, values)) = backlog.newest(number, sensor.latency_steps, now) {
            senses.values.clear();
            senses.values.extend_from_slice(values);
            put(
                percept,
                &sensor.measure,
                ring,
                age_s(taken, now, step_s),
                &mut senses.values,
            );
        }
        ring += usize::from(matches!(sensor.measure, Measure::Range(_)));
    }
    backlog.tell(now, step_s, percept, |item| senses.note(item));
}

/// Writes what a sensor measured into the percept.
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

impl Look<'_> {
    #[inline]
    fn take(&self, mind: &mut Mind, senses: &mut Senses, percept: Option<&mut Percept>) {
        let sensor = self.sensor;
        let is_lost = sensor.dropout_probability > 0.0
            && share(self.eye.words(Use::Dropout, 0)[0]) < sensor.dropout_probability;
        match &sensor.measure {
            Measure::Items(_) | Measure::Robots(_) if is_lost => {}
            Measure::Items(detector) => self.find_items(detector, mind, senses, percept),
            Measure::Robots(detector) => {
                self.find_robots(detector, mind, &mut senses.others, percept);
            }
            value => {
                self.measure(value, senses);
                self.tell_value(is_lost, mind, senses, percept);
            }
        }
    }

    /// Measures values into `senses`.
    #[inline]
    fn measure(&self, measure: &Measure, senses: &mut Senses) {
        let eye = &self.eye;
        if !matches!(measure, Measure::Range(_)) {
            senses.values.clear();
        }
        match measure {
            Measure::Range(ring) => {
                if !senses.is_near_known {
                    gather(self.view, self.robot, &mut senses.room.near);
                    senses.is_near_known = true;
                }
                ring.look(eye, &mut senses.room, &mut senses.values);
            }
            Measure::Position { noise_m } => {
                let [x, y] = deviations(eye).map(|deviation| deviation * noise_m);
                senses.values.extend([eye.at.x + x, eye.at.y + y]);
            }
            Measure::Heading { noise_rad } => {
                let heading_rad = self.view.courses[self.robot].heading_rad;
                senses
                    .values
                    .push(wrapped(heading_rad + noise_rad * deviations(eye)[0]));
            }
            Measure::Items(_) | Measure::Robots(_) => {}
        }
    }

    #[inline]
    fn tell_value(
        &self,
        is_lost: bool,
        mind: &mut Mind,
        senses: &mut Senses,
        percept: Option<&mut Percept>,
    ) {
        if self.sensor.tells_at_once() {
            if let Some(percept) = percept.filter(|_| !is_lost) {
                put(
                    percept,
                    &self.sensor.measure,
                    self.ring,
                    0.0,
                    &mut senses.values,
                );
            }
        } else if let Some(backlog) = &mut mind.backlog {
            let taken = (!is_lost).then_some(self.view.tick);
            let kept = backlog.keep(self.number, self.eye.look, taken);
            std::mem::swap(kept, &mut senses.values);
        }
    }

    fn find_items(
        &self,
        detector: &ItemDetector,
        mind: &mut Mind,
        senses: &mut Senses,
        percept: Option<&mut Percept>,
    ) {
        let scenario = self.view.scenario;
        let is_there = |place| scenario.torus.is_some() || scenario.world.contains(place);
        let is_told_now = self.sensor.latency_steps == 0;
        let mut percept = percept.filter(|_| is_told_now);
        let look = brain::Look {
            sensor: self.place(),
            age_s: 0.0,
        };
        match percept.as_deref_mut() {
            Some(percept) => percept.looks.push(look),
            None => mind.wait_look(self.late(look)),
        }
        detector.look(&self.eye, self.view.items, |way, kind, item| {
            // Beyond the border there is nothing to be taken for anything.
            if item.is_none() && !is_there(self.eye.world_of(way)) {
                return;
            }
            let (range_m, bearing_rad) = polar(way);
            let contact = Contact {
                kind,
                sensor: look.sensor,
                range_m,
                bearing_rad,
                age_s: 0.0,
            };
            match percept.as_deref_mut() {
                Some(percept) => {
                    percept.contacts.push(contact);
                    senses.note(item);
                }
                None => mind.wait_contact(self.late((contact, item))),
            }
        });
    }

    fn find_robots(
        &self,
        detector: &RobotDetector,
        mind: &mut Mind,
        others: &mut Vec<u32>,
        percept: Option<&mut Percept>,
    ) {
        let view = self.view;
        let is_told_now = self.sensor.latency_steps == 0;
        let mut percept = percept.filter(|_| is_told_now);
        let about = view.neighbours.about(self.eye.at, detector.sector.range_m);
        others.clear();
        others.extend(about.filter(|other| *other as usize != self.robot));
        // Lists of near robots have no order of their own.
        others.sort_unstable();
        let is_clear = self.is_clear(detector, others);
        for other in others.iter() {
            let other = *other as usize;
            let layers = [self.robot, other].map(|robot| view.kind(robot).layer);
            let eye = Eye {
                stands: view.scenario.hiding(layers),
                is_clear,
                ..self.eye
            };
            let (place, entity) = (
                view.scenario.image(self.eye.at, view.discs[other].centre),
                view.scenario.entity(view.ids[other]),
            );
            let Some(way) = detector.look(&eye, place, entity) else {
                continue;
            };
            let [own_rad, its_rad] =
                [self.robot, other].map(|robot| view.courses[robot].heading_rad);
            let (range_m, bearing_rad) = polar(way);
            let neighbour = Neighbour {
                range_m,
                bearing_rad,
                course_rad: detector.course_rad(&eye, its_rad - own_rad, entity),
                age_s: 0.0,
                id: view.ids[other],
            };
            match percept.as_deref_mut() {
                Some(percept) => percept.neighbours.push(neighbour),
                None => mind.wait_neighbour(self.late(neighbour)),
            }
        }
    }

    /// Whether nothing that stands hides any of the others.
    fn is_clear(&self, detector: &RobotDetector, others: &[u32]) -> bool {
        let scenario = self.view.scenario;
        let Some(first) = others.first().filter(|_| scenario.is_one_layer()) else {
            return false;
        };
        let layers = [self.robot, *first as usize].map(|robot| self.view.kind(robot).layer);
        let stands = scenario.hiding(layers);
        stands.is_clear(self.eye.at, detector.sector.range_m)
    }

    /// Place of the sensor, as brains count it.
    fn place(&self) -> u16 {
        #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
        let place = self.number as u16;
        place
    }

    fn late<T>(&self, what: T) -> Late<T> {
        let taken = self.view.tick;
        Late {
            taken,
            due: taken + self.sensor.latency_steps,
            what,
        }
    }
}

fn polar(way: Point) -> (f64, f64) {
    (way.length(), libm::atan2(way.y, way.x))
}

/// Two standard normal deviations for the error of a look.
fn deviations(eye: &Eye) -> [f64; 2] {
    let [a, b, ..] = eye.words(Use::Error, 0);
    normal_pair([a, b])
}

/// What the rays of a robot can meet.
#[inline]
pub(super) fn gather<'v>(view: &View<'v>, robot: usize, near: &mut Near) {
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
    // A body outside may be where another is; simulated ones never are.
    if view.has_bodies_outside {
        near.take_overlapping(bodies);
    } else {
        near.take_apart(bodies);
    }
    let discs = |numbers: &'v [u32]| numbers.iter().map(|number| *stands.disc(*number));
    near.take_apart(discs(vicinity.discs_apart));
    near.take_overlapping(discs(vicinity.discs_overlapping));
    near.take_walls(vicinity.walls.iter().map(|number| stands.wall(*number)));
}
