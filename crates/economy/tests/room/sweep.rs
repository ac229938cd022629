//! Robots with item detectors and a controller that clear a lane, with messages that may be lost.

use crate::network::{Network, Weather, random, unit};
use base::geometry::{Point, Rectangle};
use base::random::Stream;
use base::trig::wrapped;
use brain::{
    AgentId, Body, Brain, BrainSpec, Command, Contact, Detector, Lane, Observation, Other, Percept,
    Reading, Receiver,
};
use economy::{Clearance, Controller, LaneStatement, RobotModel, Settings, Skill};
use std::sync::Arc;

const STEP_S: f64 = 0.1;
const RANGE_M: f64 = 3.0;
const DETECTION: f64 = 0.3;
const FALSE_ALARMS_PER_M2: f64 = 1e-5;
const NOISE_M: f64 = 0.2;
const STATION: AgentId = AgentId::controller(1, 0);

/// A lane of 30 m x 10 m with two expected mines, in tiles of 10 m.
fn clearance() -> Clearance {
    let skill = Skill {
        capability: 0,
        service_s: 3.0,
    };
    Clearance {
        lane: Lane {
            min_m: [0.0; 2],
            max_m: [30.0, 10.0],
            cell_m: 2.0,
            hazards: 1,
        },
        free_shares: Vec::new(),
        expected: vec![2.0],
        destroy_probability: Vec::new(),
        robots: vec![RobotModel {
            search_nats: 3.0,
            ..RobotModel::default()
        }],
        declare_below: 0.05,
        interrogate_above: 0.05,
        tile_m: 10.0,
        searches: vec![skill],
        interrogate: Some(skill),
        neutralise: None,
    }
}

fn brain() -> Brain {
    let detector = Detector {
        range_m: RANGE_M,
        width_rad: 7.0,
        detection_probability: vec![vec![[0.0, DETECTION]]],
        false_alarms_per_m2: vec![FALSE_ALARMS_PER_M2],
        noise_m: NOISE_M,
        ..Detector::default()
    };
    let corner = |x: f64, y: f64| Point { x, y };
    let body = Body {
        radius_m: 0.25,
        max_speed_m_s: 2.0,
        max_acceleration_m_s2: f64::INFINITY,
        max_turn_rate_rad_s: 20.0,
        period_s: STEP_S,
        sensors: vec!["detector".to_owned()],
        detectors: vec![detector],
        item_kinds: vec!["mine".to_owned()],
        others: vec![Other::default()],
        field: Some(Rectangle::spanned(corner(-2.0, -2.0), corner(32.0, 12.0))),
        ..Body::default()
    };
    let spec = r#"{"limit_speed_to_stopping_distance": false, "behaviours": [{"kind": "serve"}]}"#;
    let spec: BrainSpec = serde_json::from_str(spec).unwrap();
    Brain::new(Arc::new(spec), Arc::new(body))
}

struct Robot {
    id: AgentId,
    brain: Brain,
    at: Point,
    heading_rad: f64,
}

impl Robot {
    /// What it detects: each mine in range by chance, and false alarms.
    fn contacts(&self, mines: &[Point], random: &mut Stream) -> Vec<Contact> {
        let mut contacts = Vec::new();
        let mut add = |offset: Point| {
            let bearing_rad = wrapped(offset.y.atan2(offset.x) - self.heading_rad);
            contacts.push(Contact {
                kind: 0,
                sensor: 0,
                range_m: offset.length(),
                bearing_rad,
                age_s: 0.0,
            });
        };
        for mine in mines {
            let noise = [0, 1].map(|_| NOISE_M * normal(random));
            let offset = self.at.to(*mine);
            if offset.length() <= RANGE_M && unit(random) < DETECTION {
                add(offset.plus(Point::from(noise)));
            }
        }
        let area_m2 = core::f64::consts::PI * RANGE_M * RANGE_M;
        if unit(random) < FALSE_ALARMS_PER_M2 * area_m2 {
            let (way_rad, away_m) = (
                core::f64::consts::TAU * unit(random),
                RANGE_M * unit(random).sqrt(),
            );
            let way = Point {
                x: way_rad.cos(),
                y: way_rad.sin(),
            };
            add(way.times(away_m));
        }
        contacts
    }

    fn step(&mut self, mut percept: Percept, command: &mut Command) {
        percept.id = self.id;
        percept.position = now(self.at);
        percept.heading_rad = now(self.heading_rad);
        percept.observations = vec![Observation {
            sensor: 0,
            age_s: 0.0,
        }];
        *command = self.brain.step(&percept);
        self.heading_rad = wrapped(self.heading_rad + command.motion.turn_rate_rad_s * STEP_S);
        let way = Point {
            x: self.heading_rad.cos(),
            y: self.heading_rad.sin(),
        };
        self.at = self.at.plus(way.times(command.motion.speed_m_s * STEP_S));
    }
}

#[expect(clippy::unnecessary_wraps, reason = "fields of percepts are optional")]
const fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

fn normal(random: &mut Stream) -> f64 {
    (0..12).map(|_| unit(random)).sum::<f64>() - 6.0
}

/// Two robots and a controller, until it states something about the lane; at most for 15 minutes.
fn cleared(mines: &[Point], loss: f64, seed: u64) -> Option<LaneStatement> {
    let settings = Settings {
        clearance: Some(Arc::new(clearance())),
        ..Settings::default()
    };
    let mut controller = Controller::new(Arc::new(settings));
    let weather = Weather {
        loss,
        ..Weather::default()
    };
    let (mut network, mut random) = (Network::new(weather, seed), random(seed ^ 0x5eed));
    let robots = [0, 1].map(|index| Robot {
        id: AgentId::robot(0, index),
        brain: brain(),
        at: Point {
            x: -1.0,
            y: 2.0 + 5.0 * f64::from(index),
        },
        heading_rad: 0.0,
    });
    let mut robots = Vec::from(robots);
    let ids = [robots[0].id, robots[1].id, STATION];
    for step in 1..9000_u32 {
        let now_s = STEP_S * f64::from(step);
        for id in ids {
            let mut percept = Percept {
                time_s: Some(now_s),
                random_words: [step, id.index, 5, 7],
                id,
                team_size: 2,
                inbox: network.arrived(id, now_s),
                ..Percept::default()
            };
            let mut command = Command::default();
            if let Some(robot) = robots.iter_mut().find(|robot| robot.id == id) {
                percept.contacts = robot.contacts(mines, &mut random);
                robot.step(percept, &mut command);
            } else {
                controller.step_into(&percept, &mut command);
            }
            for message in command.outbox {
                for to in ids.into_iter().filter(|to| *to != id) {
                    if message.to == Receiver::All || message.to == to.into() {
                        network.send(id, to, message, now_s);
                    }
                }
            }
        }
        if controller.lane_statement().is_some() {
            break;
        }
    }
    controller.lane_statement()
}

#[test]
fn lanes_without_mines_are_searched_and_declared_clear_also_when_messages_are_lost() {
    for (seed, loss) in (0..).zip([0.0, 0.0, 0.3, 0.3, 0.6, 0.6]) {
        let statement = cleared(&[], loss, seed).unwrap();
        assert!(statement.is_clear && statement.risk < 0.05, "{statement:?}");
        assert!(
            statement.at_s > 10.0 && statement.at_s < 300.0,
            "{statement:?}"
        );
    }
}

/// No robot can neutralise: the lane is given up when the mine has been found and confirmed.
#[test]
fn a_lane_with_a_mine_is_never_declared_clear() {
    for (seed, x) in (0..).zip([4.0, 15.0, 26.0]) {
        let statement = cleared(&[Point { x, y: 5.0 }], 0.2, seed).unwrap();
        assert!(!statement.is_clear && statement.risk > 0.9, "{statement:?}");
    }
}
