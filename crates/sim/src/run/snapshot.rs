//! What can be seen of a run from outside: where everything is, and how it fares.

use super::state::{State, Status};
use crate::bodies::Layer;
use crate::clock::seconds;
use crate::scenario::Scenario;
use base::geometry::Point;
use brain::{BelievedMap, Motion, RobotId, Thoughts};

/// A robot of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// Which it is.
    pub id: RobotId,
    /// Where its centre is.
    pub at: Point,
    /// Of the disc that it covers.
    pub radius_m: f64,
    /// On the ground or in the air.
    pub layer: Layer,
    /// Its course: 0 along x, anticlockwise, from -pi to pi.
    pub heading_rad: f64,
    /// Ahead.
    pub speed_m_s: f64,
    /// What its brain wants.
    pub wanted: Motion,
    /// Whether it can go on.
    pub status: Status,
    /// Whether its body is outside.
    pub is_external: bool,
    /// Whether something stopped it in the last step.
    pub is_touching: bool,
    /// Taken from its battery.
    pub energy_j: f64,
    /// Share of its battery that is left; `None` if it has none that empties.
    pub battery: Option<f64>,
    /// How far it has gone.
    pub distance_m: f64,
    /// New contacts that it has had.
    pub collisions: u32,
}

/// An item of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Item {
    /// Place of its kind in the scenario.
    pub kind: u16,
    /// Where it is.
    pub at: Point,
    /// When it was found, if it was.
    pub found_s: Option<f64>,
}

impl State {
    /// Steps that have been taken.
    #[must_use]
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// What a robot believes and wants; `None` if there is no such robot, or it has no agent.
    #[must_use]
    pub fn thoughts(&self, id: RobotId) -> Option<Thoughts> {
        let robot = self.ids.binary_search(&id).ok()?;
        self.agents[robot].brain.thoughts()
    }

    /// The map in a robot's agent; `None` if there is no such robot, or it has none.
    #[must_use]
    pub fn map(&self, id: RobotId) -> Option<BelievedMap> {
        let robot = self.ids.binary_search(&id).ok()?;
        self.agents[robot].brain.map()
    }

    /// All robots, in the order of their kinds and indices.
    pub fn each_robot(&self, scenario: &Scenario) -> impl Iterator<Item = Robot> {
        (0..self.robots()).map(|robot| {
            let (id, body_state) = (self.ids[robot], &self.body_states[robot]);
            let kind = &scenario.kinds[usize::from(id.kind)];
            Robot {
                id,
                at: self.discs[robot].centre,
                radius_m: self.discs[robot].radius_m,
                layer: kind.layer,
                heading_rad: self.orientations[robot].heading_rad,
                speed_m_s: body_state.speed_m_s,
                wanted: self.agents[robot].wanted,
                status: body_state.status,
                is_external: body_state.is_external,
                is_touching: body_state.is_pressed,
                energy_j: body_state.energy_j,
                battery: body_state.charge(kind),
                distance_m: body_state.distance_m,
                collisions: body_state.collisions,
            }
        })
    }

    /// All items, in the order of their kinds and indices.
    pub fn each_item(&self, scenario: &Scenario) -> impl Iterator<Item = Item> {
        self.items.each_place().map(move |(kind, at, found)| Item {
            kind,
            at,
            found_s: found.map(|tick| seconds(tick, scenario.step_s)),
        })
    }
}
