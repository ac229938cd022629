//! A kind of controller, converted for runs.

use super::ControllerSpec;
use super::lane::around_obstacles;
use crate::bodies::RobotSpec;
use crate::clock::ClockSpec;
use crate::radio::Radio;
use crate::scenario::ScenarioSpec;
use crate::sensors::Sensor;
use base::geometry::Point;
use base::placement::Placement;
use base::random::{Entity, kind_key};
use economy::{Backup, Settings};
use std::sync::Arc;

/// What all controllers of a kind have in common.
#[derive(Debug, Clone)]
pub(crate) struct ControllerKind {
    pub(crate) name: String,
    /// Its name in random streams: [`kind_key`].
    pub(crate) key: u32,
    pub(crate) count: u32,
    pub(crate) base: ControllerBase,
    pub(crate) radio: Radio,
    pub(crate) sensors: Vec<Sensor>,
    pub(crate) price: f64,
    pub(crate) mean_time_between_failures_s: Option<f64>,
    pub(crate) failed: Vec<u32>,
    pub(crate) settings: Arc<Settings>,
}

/// Where the controllers of a kind are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ControllerBase {
    Placed(Placement),
    /// Aboard the robots of the kind of this number.
    Aboard(u8),
}

impl ControllerSpec {
    /// The longest time until a robot has answered a message: two trips over the radio, and a period of its brain.
    pub(crate) fn answer_s(&self, scenario: &ScenarioSpec) -> f64 {
        let step_s = scenario.clock.step_s;
        let of_robot_s = |robot: &RobotSpec| {
            let period_s = robot.brain.rate_hz.map_or(step_s, |rate_hz| 1.0 / rate_hz);
            let radio = robot.radio.as_ref();
            radio.map_or(step_s, |radio| radio.trip_s(step_s) + period_s)
        };
        let robots_s = scenario.robots.values().map(of_robot_s);
        robots_s.fold(step_s, f64::max) + self.radio.trip_s(step_s)
    }

    /// Whether another controller of the kind has to vote for the owner of a goal.
    pub(crate) fn has_voters(&self) -> bool {
        self.backup == Backup::Majority && self.count > 1
    }

    /// Its settings in a scenario.
    pub(crate) fn settings(&self, scenario: &ScenarioSpec) -> Settings {
        let max_drift = scenario.clock.max_drift;
        Settings {
            allocation: self.allocation,
            service_lease_s: self.service_lease_s,
            count: self.count.max(1),
            backup: self.backup,
            trade: self.trade,
            owner_lease_s: self.owner_lease_s,
            auction_s: self.auction_s,
            max_goals: self.max_goals,
            max_drift,
            answer_s: self.answer_s(scenario),
            clearance: None,
            passage: None,
            is_called_off: self.clearance.as_ref().is_some_and(|lane| lane.called_off),
        }
    }
}

impl ControllerKind {
    /// The kind that `spec` describes in a scenario, of which controllers of lanes know what obstacles cover, if there are any.
    pub(crate) fn new(
        (name, spec): (&String, &ControllerSpec),
        scenario: &ScenarioSpec,
        is_covered: Option<&dyn Fn(Point) -> bool>,
    ) -> Self {
        let ClockSpec { step_s, .. } = scenario.clock;
        let clearance = spec.clearance.as_ref();
        let clearance = clearance.map(|clearance| {
            let clearance = clearance.ready(scenario);
            Arc::new(match is_covered {
                Some(is_covered) => around_obstacles(clearance, is_covered),
                None => clearance,
            })
        });
        let settings = Settings {
            clearance,
            ..spec.settings(scenario)
        };
        let carrier = spec.aboard.as_ref();
        let mut robots = scenario.robots.keys();
        let carrier = carrier.and_then(|kind| robots.position(|known| known == kind));
        let carrier = carrier.and_then(|number| u8::try_from(number).ok());
        let placed = || ControllerBase::Placed(spec.start.clone().unwrap_or_default());
        let sensors = (0..).zip(&spec.sensors).map(|(number, (sensor, spec))| {
            let context = spec.context(number, (name, sensor), &[], step_s);
            Sensor::new(spec, &context, step_s)
        });
        Self {
            sensors: sensors.collect(),
            name: name.clone(),
            key: kind_key(name),
            count: spec.count,
            base: carrier.map_or_else(placed, ControllerBase::Aboard),
            radio: Radio::new(&spec.radio, step_s),
            price: spec.price,
            mean_time_between_failures_s: spec.mean_time_between_failures_s,
            failed: spec.failed.clone(),
            settings: Arc::new(settings),
        }
    }

    /// The key of one of its controllers in random streams.
    pub(crate) fn entity(&self, index: u32) -> Entity {
        Entity {
            kind: self.key,
            index,
        }
    }
}
