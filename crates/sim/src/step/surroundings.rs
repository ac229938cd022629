//! What the detectors of controllers can detect: all robots and the other controllers.

use crate::bodies::Layer;
use crate::bodies::body_state::BodyState;
use crate::clock::seconds;
use crate::run::participant::{Participant, Place};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::Sensor;
use crate::sensors::buffers::Buffers;
use crate::sensors::rays::Near;
use crate::sensors::scene::{Other, Scene};
use crate::sensors::sensor_frame::SensorFrame;
use crate::world::items::Items;
use base::geometry::Point;
use base::random::Entity;
use brain::{AgentId, Percept};

/// What all controllers step from.
pub(super) struct Moment<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) tick: u64,
    pub(super) body_states: &'a [BodyState],
    pub(super) items: &'a Items,
}

/// The direction in which a controller faces.
const FRONT: Point = Point { x: 1.0, y: 0.0 };

/// All robots and controllers in the order of their numbers; empty if no controller has a detector.
#[derive(Debug, Clone, Default)]
pub(super) struct Surroundings {
    all: Vec<Detectable>,
    buffers: Buffers,
}

/// A robot or a controller.
#[derive(Debug, Clone, Copy)]
struct Detectable {
    id: AgentId,
    key: Entity,
    at: Point,
    uncertainty_m: f64,
    heading_rad: f64,
    layer: Layer,
}

impl Surroundings {
    /// Notes where everything is at the beginning of a step.
    pub(super) fn refresh(&mut self, scenario: &Scenario, state: &State) {
        self.all.clear();
        let mut kinds = scenario.controllers.iter();
        if kinds.all(|kind| kind.sensors.is_empty()) {
            return;
        }
        let robots = state.ids.iter().enumerate();
        self.all.extend(robots.map(|(robot, id)| {
            let kind = scenario.kind_of(*id);
            Detectable {
                id: *id,
                key: kind.entity(id.index),
                at: state.discs[robot].centre,
                uncertainty_m: state.uncertainty_m(robot),
                heading_rad: state.orientations[robot].heading_rad,
                layer: kind.layer,
            }
        }));
        let robots = self.all.len();
        for agent in &state.controllers {
            let participant = &agent.participant;
            let (at, layer) = match participant.place {
                Place::Fixed(at, layer) => (at, layer),
                Place::Aboard(robot) => {
                    let carrier = &self.all[..robots][robot as usize];
                    (carrier.at, carrier.layer)
                }
            };
            self.all.push(Detectable {
                id: participant.id,
                key: participant.key,
                at,
                uncertainty_m: 0.0,
                heading_rad: 0.0,
                layer,
            });
        }
    }

    /// Adds what the sensors of a controller detect in a step.
    pub(super) fn detect(
        &mut self,
        moment: &Moment,
        participant: &Participant,
        sensors: &[Sensor],
        percept: &mut Percept,
    ) {
        let Place::Fixed(at, layer) = participant.place else {
            return;
        };
        let scene = ControllerScene {
            all: &self.all,
            moment,
            id: participant.id,
            at,
            layer,
        };
        for (number, sensor) in (0..).zip(sensors) {
            let Some(measurement) = sensor.schedule.due(moment.tick) else {
                continue;
            };
            let frame = SensorFrame {
                at,
                front: FRONT,
                noise: participant.noise,
                sensor: number,
                measurement,
                geometry: moment.scenario.hiding([layer; 2]),
                is_clear: false,
            };
            if !sensor.is_dropped(&frame) {
                let measure = &sensor.measure;
                measure.measure(&frame, &scene, &mut self.buffers, percept);
            }
        }
    }
}

/// The world around a controller.
struct ControllerScene<'a> {
    all: &'a [Detectable],
    moment: &'a Moment<'a>,
    id: AgentId,
    at: Point,
    layer: Layer,
}

impl Scene for ControllerScene<'_> {
    fn time_s(&self) -> f64 {
        seconds(self.moment.tick, self.moment.scenario.step_s)
    }

    fn heading_rad(&self) -> f64 {
        0.0
    }

    fn items(&self) -> &Items {
        self.moment.items
    }

    fn contains(&self, place: Point) -> bool {
        self.moment.scenario.has_place(place)
    }

    /// Nothing: controllers cast no rays, and have no lists of what is near.
    fn gather(&self, near: &mut Near) {
        near.begin(self.at, 0.0);
    }

    /// All others: a controller looks farther than the lists of robots reach.
    fn others_within(&self, _range_m: f64, to: &mut Vec<u32>) {
        let others = (0..).zip(self.all).filter(|(_, other)| other.id != self.id);
        to.clear();
        to.extend(others.map(|(number, _)| number));
    }

    fn is_clear(&self, _range_m: f64, _others: &[u32]) -> bool {
        false
    }

    fn other(&self, number: u32) -> Other<'_> {
        let scenario = self.moment.scenario;
        let other = &self.all[number as usize];
        Other {
            id: other.id,
            key: other.key,
            at: scenario.image(self.at, other.at),
            uncertainty_m: other.uncertainty_m,
            geometry: scenario.hiding([self.layer, other.layer]),
        }
    }

    fn heading_rad_of(&self, number: u32) -> f64 {
        self.all[number as usize].heading_rad
    }
}
