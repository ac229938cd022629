//! What a robot can do for goals, the same for all robots of a kind, and its state in a step.

use super::lanes::Lanes;
use crate::io::body::{Body, RobotId};
use crate::io::dispatch::{Reason, Task, Work};
use crate::io::percept::Percept;
use crate::perception::beliefs::Map;
use alloc::vec::Vec;
use base::geometry::Point;

/// A slower robot is stationary.
const MIN_SPEED_M_S: f64 = 1e-3;

/// What a robot can do.
#[derive(Debug, Clone)]
pub(crate) struct Ability {
    /// Speed between goals.
    pub(crate) speed_m_s: f64,
    /// Maximum number of goals that it serves.
    pub(crate) max_goals: usize,
    /// Its path of a search.
    pub(crate) lanes: Lanes,
    /// Within this distance, it detects items in all directions.
    pub(crate) all_round_m: f64,
    pub(crate) capabilities: Vec<u8>,
    /// Kinds of participants from this number on are controllers.
    pub(crate) robot_kinds: usize,
}

impl Ability {
    /// Why the robot can never serve a goal, if it cannot.
    pub(crate) fn lacks(&self, task: &Task) -> Option<Reason> {
        let has = task.capability == 0 || self.capabilities.contains(&task.capability);
        // Brains have no command to neutralise yet.
        let can = task.work != Work::Neutralise;
        (!has || !can).then_some(Reason::Capability)
    }

    /// Time that the work at a goal takes.
    pub(crate) fn work_s(&self, task: &Task) -> f64 {
        let search_m = match task.work {
            Work::Visit | Work::Interrogate | Work::Neutralise => 0.0,
            Work::Search => self.lanes.length_m(task),
        };
        f64::from(task.service_s) + self.travel_s(search_m)
    }

    /// Whether it cannot drive: it serves only goals that it [covers](Self::covers).
    pub(crate) fn is_stationary(&self) -> bool {
        self.speed_m_s < MIN_SPEED_M_S
    }

    /// Time to drive a distance; none for a robot that does not drive to its goals.
    pub(crate) fn travel_s(&self, distance_m: f64) -> f64 {
        if self.is_stationary() {
            0.0
        } else {
            distance_m / self.speed_m_s
        }
    }

    /// Whether a robot that remains at a position is at a goal there and, for a search, detects items
    /// in the whole area.
    pub(crate) fn covers(&self, task: &Task, at: Point) -> bool {
        let (away_m, radius_m) = (at.to(task.at()).length(), f64::from(task.radius_m));
        let is_seen = task.work != Work::Search || away_m + radius_m <= self.all_round_m;
        away_m <= radius_m && is_seen
    }

    /// Whether an agent is a controller.
    pub(crate) fn is_controller(&self, id: RobotId) -> bool {
        usize::from(id.kind) >= self.robot_kinds && id.kind != RobotId::OPERATOR.kind
    }
}

/// The state of a robot in a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'s> {
    pub(crate) percept: &'s Percept,
    pub(crate) body: &'s Body,
    /// Its map, if it has one.
    pub(crate) map: Option<&'s Map>,
    /// Its position, if known.
    pub(crate) at: Option<Point>,
    pub(crate) elapsed_s: f64,
    /// Remaining time of the battery, and its charge if known.
    pub(crate) battery_s: f64,
    pub(crate) charge: Option<f64>,
}
