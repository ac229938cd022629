//! One measurement of one sensor of a robot.

use super::destination::Destination;
use super::view::View;
use crate::clock::seconds;
use crate::sensors::backlog::Backlog;
use crate::sensors::items::ItemDetector;
use crate::sensors::range::RingBuffers;
use crate::sensors::rays::Near;
use crate::sensors::robots::RobotDetector;
use crate::sensors::sensor_frame::{NoisePurpose, SensorFrame};
use crate::sensors::{Measure, Sensor};
use base::geometry::{Disc, Point};
use base::noise::{normal_pair, share};
use base::trig::wrapped;
use brain::{Contact, Neighbour, Observation, Percept, Reading};

/// Buffers for the measurements of one robot.
#[derive(Debug, Clone, Default)]
pub(super) struct Buffers {
    /// With what the rays of the robot can meet, once one of its range sensors has measured.
    rays: RingBuffers,
    is_near_known: bool,
    /// The values of a measurement.
    pub(super) values: Vec<f64>,
    /// Robots that may be detected.
    others: Vec<u32>,
}

impl Buffers {
    /// Drops what belongs to the robot before.
    pub(super) fn begin_robot(&mut self) {
        self.is_near_known = false;
    }
}

/// One measurement.
pub(super) struct Measurement<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) robot: usize,
    pub(super) sensor: &'a Sensor,
    pub(super) frame: SensorFrame<'a>,
    /// Index of the sensor on the robot, and of a range sensor among the range sensors.
    pub(super) number: usize,
    pub(super) ring: usize,
}

impl Measurement<'_> {
    /// Takes the measurement; its results go to `destination`.
    #[inline]
    pub(super) fn take(&self, buffers: &mut Buffers, mut destination: Destination) {
        match &self.sensor.measure {
            _ if self.is_dropped() => {}
            Measure::Items(detector) => self.find_items(detector, &mut destination),
            Measure::Robots(detector) => {
                self.find_robots(detector, &mut buffers.others, &mut destination);
            }
            _ => self.store_values(buffers, destination),
        }
    }

    /// The backlog as a destination: the result waits there for the latency of the sensor.
    pub(super) fn later<'b>(&self, backlog: &'b mut Backlog) -> Destination<'b> {
        let taken = self.view.tick;
        Destination::Backlog {
            backlog,
            taken,
            due: taken + self.sensor.latency_steps,
        }
    }

    #[inline]
    fn is_dropped(&self) -> bool {
        let probability = self.sensor.dropout_probability;
        probability > 0.0 && share(self.frame.words(NoisePurpose::DropOut, 0)[0]) < probability
    }

    /// Takes a measurement of values, which the next one replaces.
    #[inline]
    fn store_values(&self, buffers: &mut Buffers, destination: Destination) {
        self.measure(buffers);
        let values = &mut buffers.values;
        match destination {
            Destination::Percept { percept, .. } => {
                write(percept, &self.sensor.measure, self.ring, 0.0, values);
            }
            Destination::Backlog { backlog, taken, .. } => {
                if let Some(stored) = backlog.keep(self.number, taken) {
                    std::mem::swap(stored, values);
                }
            }
        }
    }

    /// Measures values into the buffer.
    #[inline]
    fn measure(&self, buffers: &mut Buffers) {
        let frame = &self.frame;
        let values = &mut buffers.values;
        match &self.sensor.measure {
            Measure::Range(ring) => {
                if !buffers.is_near_known {
                    gather(self.view, self.robot, &mut buffers.rays.near);
                    buffers.is_near_known = true;
                }
                ring.measure(frame, &mut buffers.rays, values);
            }
            Measure::Position { noise_m, drift } => {
                let [x, y] = deviations(frame).map(|deviation| deviation * noise_m);
                values.clear();
                values.extend([frame.at.x + x, frame.at.y + y]);
                if let Some(drift) = drift {
                    let error = drift.at(frame, seconds(self.view.tick, self.view.scenario.step_s));
                    values[0] += error.x;
                    values[1] += error.y;
                }
            }
            Measure::Heading { noise_rad } => {
                let heading_rad = self.view.orientations[self.robot].heading_rad;
                values.clear();
                values.push(wrapped(heading_rad + noise_rad * deviations(frame)[0]));
            }
            Measure::Items(_) | Measure::Robots(_) => {}
        }
    }

    fn find_items(&self, detector: &ItemDetector, destination: &mut Destination) {
        let scenario = self.view.scenario;
        let is_there = |place| scenario.torus.is_some() || scenario.world.contains(place);
        let sensor = self.index();
        destination.add_observation(Observation { sensor, age_s: 0.0 });
        detector.measure(&self.frame, self.view.items, |way, kind, item| {
            // Beyond the border there are no false alarms.
            if item.is_none() && !is_there(self.frame.world_of(way)) {
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
            destination.add_contact(contact, item);
        });
    }

    fn find_robots(
        &self,
        detector: &RobotDetector,
        others: &mut Vec<u32>,
        destination: &mut Destination,
    ) {
        let (at, range_m) = (self.frame.at, detector.sector.range_m);
        let about = self.view.neighbours.about(at, range_m);
        others.clear();
        others.extend(about.filter(|other| *other as usize != self.robot));
        // Lists of near robots have no particular order.
        others.sort_unstable();
        let is_clear = self.is_clear(detector, others);
        for other in others.iter() {
            if let Some(neighbour) = self.neighbour(detector, *other as usize, is_clear) {
                destination.add_neighbour(neighbour);
            }
        }
    }

    /// Another robot as the sensor detects it, if it does.
    #[inline]
    fn neighbour(
        &self,
        detector: &RobotDetector,
        other: usize,
        is_clear: bool,
    ) -> Option<Neighbour> {
        let view = self.view;
        let layers = [self.robot, other].map(|robot| view.kind(robot).layer);
        let frame = SensorFrame {
            geometry: view.scenario.hiding(layers),
            is_clear,
            ..self.frame
        };
        let place = view.scenario.image(frame.at, view.discs[other].centre);
        let entity = view.kind(other).entity(view.ids[other].index);
        let (range_m, bearing_rad) = polar(detector.measure(&frame, place, entity)?);
        let [own_rad, its_rad] =
            [self.robot, other].map(|robot| view.orientations[robot].heading_rad);
        Some(Neighbour {
            range_m,
            bearing_rad,
            course_rad: detector.course_rad(&frame, its_rad - own_rad, entity),
            age_s: 0.0,
            id: view.ids[other],
        })
    }

    /// Whether static geometry hides none of the others.
    fn is_clear(&self, detector: &RobotDetector, others: &[u32]) -> bool {
        let scenario = self.view.scenario;
        let Some(first) = others.first().filter(|_| scenario.is_one_layer()) else {
            return false;
        };
        let layers = [self.robot, *first as usize].map(|robot| self.view.kind(robot).layer);
        let geometry = scenario.hiding(layers);
        geometry.is_clear(self.frame.at, detector.sector.range_m)
    }

    /// Index of the sensor, as brains count it.
    fn index(&self) -> u16 {
        #[expect(clippy::cast_possible_truncation, reason = "a robot has at most 32")]
        let index = self.number as u16;
        index
    }
}

/// Writes the values of a measurement into the percept.
pub(super) fn write(
    percept: &mut Percept,
    measure: &Measure,
    ring: usize,
    age_s: f64,
    values: &mut Vec<f64>,
) {
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
    let geometry = view.scenario.seen(kind.layer);
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
    let discs = |numbers: &'v [u32]| numbers.iter().map(|number| *geometry.disc(*number));
    near.take_apart(discs(vicinity.discs_apart));
    near.take_overlapping(discs(vicinity.discs_overlapping));
    near.take_walls(vicinity.walls.iter().map(|number| geometry.wall(*number)));
}
