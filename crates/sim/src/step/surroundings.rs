//! What the detectors of controllers can detect: all robots and the other controllers.

use crate::bodies::Layer;
use crate::run::participant::{Participant, Place};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::{NoisePurpose, SensorFrame};
use crate::sensors::{Measure, Sensor};
use base::geometry::Point;
use base::noise::share;
use base::random::Entity;
use brain::{AgentId, Neighbour};

/// The direction in which a controller faces.
const FRONT: Point = Point { x: 1.0, y: 0.0 };

/// All robots and controllers in the order of their numbers; empty if no controller has a detector.
#[derive(Debug, Clone, Default)]
pub(super) struct Surroundings(Vec<Detectable>);

/// A robot or a controller.
#[derive(Debug, Clone, Copy)]
struct Detectable {
    id: AgentId,
    key: Entity,
    at: Point,
    heading_rad: f64,
    layer: Layer,
}

impl Surroundings {
    /// Notes where everything is at the beginning of a step.
    pub(super) fn refresh(&mut self, scenario: &Scenario, state: &State) {
        self.0.clear();
        let mut kinds = scenario.controllers.iter();
        if kinds.all(|kind| kind.sensors.is_empty()) {
            return;
        }
        let robots = state.ids.iter().enumerate();
        self.0.extend(robots.map(|(robot, id)| {
            let kind = scenario.kind_of(*id);
            Detectable {
                id: *id,
                key: kind.entity(id.index),
                at: state.discs[robot].centre,
                heading_rad: state.orientations[robot].heading_rad,
                layer: kind.layer,
            }
        }));
        let robots = self.0.len();
        for agent in &state.controllers {
            let participant = &agent.participant;
            let (at, layer) = match participant.place {
                Place::Fixed(at, layer) => (at, layer),
                Place::Aboard(robot) => {
                    let carrier = &self.0[..robots][robot as usize];
                    (carrier.at, carrier.layer)
                }
            };
            self.0.push(Detectable {
                id: participant.id,
                key: participant.key,
                at,
                heading_rad: 0.0,
                layer,
            });
        }
    }

    /// Adds what the sensors of a controller detect in a step.
    pub(super) fn detect(
        &self,
        (scenario, tick): (&Scenario, u64),
        participant: &Participant,
        sensors: &[Sensor],
        neighbours: &mut Vec<Neighbour>,
    ) {
        let Place::Fixed(at, layer) = participant.place else {
            return;
        };
        for (number, sensor) in (0..).zip(sensors) {
            let Some(measurement) = sensor.schedule.due(tick) else {
                continue;
            };
            let frame = SensorFrame {
                at,
                front: FRONT,
                noise: participant.noise,
                sensor: number,
                measurement,
                geometry: scenario.hiding([layer; 2]),
                is_clear: false,
            };
            let random = share(frame.words(NoisePurpose::DropOut, 0)[0]);
            if random >= sensor.dropout_probability {
                let others = self.0.iter().filter(|other| other.id != participant.id);
                let detected =
                    others.filter_map(|other| measured(scenario, &frame, (sensor, layer), other));
                neighbours.extend(detected);
            }
        }
    }
}

/// A robot or controller as a sensor in a layer detects it, if it does.
fn measured(
    scenario: &Scenario,
    frame: &SensorFrame,
    (sensor, layer): (&Sensor, Layer),
    other: &Detectable,
) -> Option<Neighbour> {
    let Measure::Robots(detector) = &sensor.measure else {
        return None;
    };
    let frame = SensorFrame {
        geometry: scenario.hiding([layer, other.layer]),
        ..*frame
    };
    let place = scenario.image(frame.at, other.at);
    let way = detector.measure(&frame, place, other.key)?;
    Some(Neighbour {
        range_m: way.length(),
        bearing_rad: libm::atan2(way.y, way.x),
        course_rad: detector.course_rad(&frame, other.heading_rad, other.key),
        age_s: 0.0,
        id: other.id,
    })
}
