//! What can be observed of a run: poses, items and states.

use super::state::State;
use crate::bodies::Layer;
use crate::bodies::body_state::Status;
use crate::clock::seconds;
use crate::scenario::Scenario;
use base::geometry::Point;
use brain::{AgentId, AssignedGoal, BeliefState, BelievedMap, Motion, ServedGoal};

/// A robot of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// Its id.
    pub id: AgentId,
    /// Position of its centre.
    pub at: Point,
    /// Radius of its footprint.
    pub radius_m: f64,
    /// On the ground or in the air.
    pub layer: Layer,
    /// Its heading: 0 along x, anticlockwise, from -pi to pi.
    pub heading_rad: f64,
    /// Forward speed.
    pub speed_m_s: f64,
    /// The motion setpoint of its brain.
    pub setpoint: Motion,
    /// Whether it can still move.
    pub status: Status,
    /// Whether its body is external.
    pub is_external: bool,
    /// Whether something stopped it in the last step.
    pub is_touching: bool,
    /// Energy taken from its battery.
    pub energy_j: f64,
    /// Remaining fraction of its battery; `None` if it never runs empty.
    pub battery: Option<f64>,
    /// Distance covered.
    pub distance_m: f64,
    /// Number of new contacts.
    pub collisions: u32,
}

/// An item of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Item {
    /// Index of its kind in the scenario.
    pub kind: u16,
    /// Its position.
    pub at: Point,
    /// When it was found, if it was.
    pub found_s: Option<f64>,
    /// The robot that detected it first; `None` if none did, or if the robot was removed.
    pub found_by: Option<AgentId>,
    /// Whether it was destroyed: by a charge, or with a robot.
    pub is_destroyed: bool,
}

impl State {
    /// Number of steps taken.
    #[must_use]
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The beliefs and goals of a robot; `None` if there is no such robot, or its brain has no
    /// beliefs.
    #[must_use]
    pub fn belief_state(&self, id: AgentId) -> Option<BeliefState> {
        let robot = self.ids.binary_search(&id).ok()?;
        self.agents[robot].brain.belief_state()
    }

    /// The goals that a person has assigned to a robot; none if there is no such robot.
    #[must_use]
    pub fn assigned_goals(&self, id: AgentId) -> Vec<AssignedGoal> {
        let robot = self.ids.binary_search(&id);
        robot.map_or_else(
            |_| Vec::new(),
            |robot| self.agents[robot].brain.assigned_goals(),
        )
    }

    /// The goals of controllers that a robot serves, in its order; none if there is no such robot, or it has failed
    /// or has no energy: its leases are not counted down.
    #[must_use]
    pub fn served_goals(&self, id: AgentId) -> Vec<ServedGoal> {
        let robot = self.ids.binary_search(&id).ok();
        let robot = robot.filter(|robot| self.body_states[*robot].status == Status::Active);
        robot.map_or_else(Vec::new, |robot| self.agents[robot].brain.served_goals())
    }

    /// The map of a robot; `None` if there is no such robot, or it has none.
    #[must_use]
    pub fn map(&self, id: AgentId) -> Option<BelievedMap> {
        let robot = self.ids.binary_search(&id).ok()?;
        self.agents[robot].brain.map()
    }

    /// All robots, in the order of their kinds and indices.
    pub fn each_robot(&self, scenario: &Scenario) -> impl Iterator<Item = Robot> {
        (0..self.robots()).map(|robot| {
            let (id, body_state) = (self.ids[robot], &self.body_states[robot]);
            let kind = scenario.kind_of(id);
            Robot {
                id,
                at: self.discs[robot].centre,
                radius_m: self.discs[robot].radius_m,
                layer: kind.layer,
                heading_rad: self.orientations[robot].heading_rad,
                speed_m_s: body_state.speed_m_s,
                setpoint: self.agents[robot].setpoint,
                status: body_state.status,
                is_external: body_state.is_external(),
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
        let items = self.items.kinds().zip(self.items.places());
        let items = (0..).zip(items.zip(self.tally.records()));
        items.map(|(number, ((kind, at), record))| Item {
            kind,
            at,
            found_s: record.found_at().map(|tick| seconds(tick, scenario.step_s)),
            found_by: record.detected.and_then(|detection| detection.by),
            is_destroyed: self.items.is_gone(number),
        })
    }
}
