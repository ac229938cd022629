//! What controllers know of the lane that they are to clear, and of the robots that clear it.

use super::clearance::{ClearanceSpec, SkillSpec};
use crate::bodies::RobotSpec;
use crate::goals::kind::capability;
use crate::scenario::ScenarioSpec;
use crate::scenario::areas::number;
use crate::sensors::SensorSpec;
use crate::sensors::detection::Detection;
use crate::sensors::items::ItemsSpec;
use crate::sensors::pass::{Pass, Path};
use crate::sensors::sensor_kind::AmongKinds;
use base::geometry::{Point, Rectangle};
use brain::{Lane, MARK_KINDS};
use economy::{Charge, Clearance, RobotModel, Skill};
use std::borrow::Cow;

/// Places of a cell along each side that are examined for obstacles.
const SAMPLES: u32 = 4;

/// A pass counts as at most this many nats: more are never certain.
const MAX_SEARCH_NATS: f64 = 6.0;

impl ClearanceSpec {
    /// What controllers of a scenario know of the lane.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(crate) fn ready(&self, scenario: &ScenarioSpec) -> Clearance {
        let capabilities = scenario.capabilities();
        let skill = |spec: &SkillSpec| spec.ready(&capabilities);
        let kinds = scenario.items.iter().zip(0..MARK_KINDS);
        let hazards = kinds.filter(|((_, kind), _)| kind.target);
        let area = self.area(scenario);
        Clearance {
            lane: Lane {
                min_m: [area.min().x, area.min().y].map(|along_m| along_m as f32),
                max_m: [area.max().x, area.max().y].map(|along_m| along_m as f32),
                cell_m: self.cell_m as f32,
                hazards: hazards.fold(0, |bits, (_, place)| bits | 1 << place),
            },
            free_shares: Vec::new(),
            expected: self.expected(scenario),
            destroy_probability: scenario
                .items
                .values()
                .map(|kind| {
                    kind.hazard
                        .as_ref()
                        .map_or(0.0, |hazard| hazard.destroy_probability)
                })
                .collect(),
            robots: scenario
                .robots
                .iter()
                .map(|robot| model(robot, scenario, &capabilities))
                .collect(),
            declare_below: self.declare_below,
            interrogate_above: self.interrogate_above,
            tile_m: self.tile_m as f32,
            searches: self.searches.iter().map(skill).collect(),
            interrogate: self.interrogate.as_ref().map(skill),
            neutralise: self
                .neutralise
                .as_ref()
                .map(|spec| charge(skill(spec), scenario)),
        }
    }

    /// The area of the lane.
    pub(crate) fn area(&self, scenario: &ScenarioSpec) -> Rectangle {
        let [width, height] = scenario.world.size_m;
        let world = [[0.0; 2], [width.0, height.0]];
        let [min, max] = self.lane_m.unwrap_or(world).map(Point::from);
        Rectangle::spanned(min, max)
    }

    fn expected(&self, scenario: &ScenarioSpec) -> Vec<f64> {
        let kinds = scenario.items.iter().take(MARK_KINDS);
        let expected = kinds.map(|(name, kind)| {
            let expected = self.expected_count.get(name).copied();
            expected.unwrap_or_else(|| kind.count.into())
        });
        expected.collect()
    }
}

impl SkillSpec {
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    fn ready(&self, capabilities: &[String]) -> Skill {
        let required = self.requires.as_ref();
        Skill {
            capability: required.map_or(0, |name| capability(name, capabilities)),
            service_s: self.service_s as f32,
        }
    }
}

/// The lane in a world with obstacles: controllers know which ground these cover.
pub(crate) fn around_obstacles(
    clearance: Clearance,
    is_covered: &dyn Fn(Point) -> bool,
) -> Clearance {
    let lane = clearance.lane;
    let share = |cell: usize| {
        let area = lane.cell_area(cell);
        let size = area.size();
        let along = |step: u32| (f64::from(step) + 0.5) / f64::from(SAMPLES);
        let steps = (0..SAMPLES).flat_map(|row| (0..SAMPLES).map(move |column| (column, row)));
        let places = steps.map(|(column, row)| Point {
            x: area.min().x + size.x * along(column),
            y: area.min().y + size.y * along(row),
        });
        let free = places.filter(|place| !is_covered(*place)).count();
        number(free) / f64::from(SAMPLES * SAMPLES)
    };
    Clearance {
        free_shares: (0..lane.cells()).map(share).collect(),
        ..clearance
    }
}

/// The lane if all sensors were known as they are, by the same ground that they can see; `None` if they are.
pub(crate) fn in_truth(clearance: &Clearance, scenario: &ScenarioSpec) -> Option<Clearance> {
    let mut truth = scenario.clone();
    let sensors = truth.robots.values_mut();
    let sensors = sensors.flat_map(|robot| robot.sensors.values_mut());
    let mut is_believed = false;
    for sensor in sensors {
        if let Some(items) = ItemsSpec::of_mut(&mut sensor.measures) {
            is_believed |= items.believed.take().is_some();
        }
    }
    let capabilities = truth.capabilities();
    let robots = truth.robots.iter().zip(&clearance.robots);
    let robots = robots.map(|(robot, known)| RobotModel {
        seen: known.seen.clone(),
        ..model(robot, &truth, &capabilities)
    });
    is_believed.then(|| Clearance {
        robots: robots.collect(),
        ..clearance.clone()
    })
}

/// The weakest charge of all robots.
fn charge(skill: Skill, scenario: &ScenarioSpec) -> Charge {
    let robots = scenario.robots.values();
    let tools = robots.filter_map(|robot| robot.tools.neutralise.as_ref());
    let weakest = tools.map(|tool| (tool.success_probability, tool.reach_m));
    let weakest = weakest.reduce(|one, other| (one.0.min(other.0), one.1.min(other.1)));
    let (success_probability, reach_m) = weakest.unwrap_or_default();
    Charge {
        skill,
        success_probability,
        reach_m,
    }
}

/// What controllers believe of the item detectors of a kind of robots, which are of one model.
fn model(
    (name, robot): (&String, &RobotSpec),
    scenario: &ScenarioSpec,
    capabilities: &[String],
) -> RobotModel {
    let sensors: Vec<(u32, Cow<ItemsSpec>, &SensorSpec)> = detectors(robot)
        .map(|(sensor, items, spec)| {
            let believed = items.as_believed(scenario.items.keys());
            (items.model_key(name, sensor), believed, spec)
        })
        .collect();
    let blind = |kind: &String| {
        let able = sensors
            .iter()
            .filter(|(_, items, _)| items.may_detect(kind));
        let shares = able.map(|(_, items, _)| items.blind_share.get(kind).copied().unwrap_or(0.0));
        shares.reduce(f64::max).unwrap_or(1.0)
    };
    let item_kinds: Vec<String> = scenario.items.keys().cloned().collect();
    let appearances = sensors.iter();
    let mut appearances = appearances.map(|(_, items, _)| items.appearances(&item_kinds));
    let lookalikes = appearances.find(|rows| !rows.is_empty());
    let nats = sensors
        .iter()
        .map(|(_, items, sensor)| pass_nats(items, sensor, robot, scenario));
    let numbers = robot.capabilities.iter();
    RobotModel {
        model: sensors.first().map_or(0, |(model, ..)| *model),
        blind_share: scenario.items.keys().take(MARK_KINDS).map(blind).collect(),
        lookalike_share: lookalikes.unwrap_or_default(),
        capabilities: numbers.map(|name| capability(name, capabilities)).collect(),
        search_nats: nats.sum::<f64>().min(MAX_SEARCH_NATS),
        seen: Vec::new(),
    }
}

/// The item detectors of a kind of robots, with their names.
pub(crate) fn detectors(
    robot: &RobotSpec,
) -> impl Iterator<Item = (&String, &ItemsSpec, &SensorSpec)> {
    let sensors = robot.sensors.iter();
    sensors.filter_map(|(name, sensor)| Some((name, ItemsSpec::of(&sensor.measures)?, sensor)))
}

/// How often a pass at the robot's speed misses an item in its swath that the sensor can detect, in nats; of the kind
/// that it detects least.
fn pass_nats(
    items: &ItemsSpec,
    sensor: &SensorSpec,
    robot: &RobotSpec,
    scenario: &ScenarioSpec,
) -> f64 {
    let path = Path::new(robot, sensor, scenario.clock.step_s);
    if path.speed_m_s <= 0.0 || items.sector.range_m <= 0.0 {
        return 0.0;
    }
    let always = Detection::Constant(1.0);
    let targets = scenario.items.iter().filter(|(_, kind)| kind.target);
    let of = |name: &String| match &items.detection_probability {
        None => Some(&always),
        Some(kinds) => kinds.get(name),
    };
    let nats = targets.map(|(name, _)| {
        of(name).map_or(0.0, |detection| {
            -libm::log1p(-Pass::new(items, detection, path).in_swath)
        })
    });
    nats.reduce(f64::min).unwrap_or_default()
}
