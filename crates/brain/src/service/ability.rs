//! What a robot can do for goals, the same for all robots of a kind, and its state in a step.

use super::lanes::Lanes;
use crate::io::act::Tool;
use crate::io::body::Body;
use crate::io::percept::Percept;
use crate::io::reason::Reason;
use crate::io::work::{Effect, Task};
use crate::navigation::hazards::WORK_REACH_M;
use crate::perception::beliefs::{Beliefs, Map};
use alloc::sync::Arc;
use base::geometry::Point;

/// A slower robot is stationary.
const MIN_SPEED_M_S: f64 = 1e-3;

/// An uncertain position is within this many standard deviations.
const DEVIATIONS: f64 = 3.0;

/// Robots that look or act drive this part of the permitted distance to the place: estimated positions move while they
/// look.
const APPROACH: f64 = 0.8;

/// Robots that have to come that near stand at least this far outside the distance that they keep from what may destroy
/// them, for the error of its position, in metres.
const ROOM_M: f64 = 0.3;

/// Time for which what is marked is in view before a robot is too near to it, in seconds, and the lowest speed for that.
const LOOK_S: f64 = 3.0;
const MIN_CLOSE_SPEED_M_S: f64 = 0.1;

/// What a robot can do.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ability {
    /// Speed between goals.
    pub(crate) speed_m_s: f64,
    /// Maximum number of goals that it serves.
    pub(crate) max_goals: usize,
    /// Its path of a search.
    pub(crate) lanes: Lanes,
    /// Within this distance, it detects items in all directions.
    pub(crate) all_round_m: f64,
    /// Range of its item detectors towards its front; 0 without any.
    pub(crate) ahead_m: f64,
    /// Standard deviation of its position sensor.
    pub(crate) position_noise_m: f64,
    /// The distance that it keeps from what may destroy it, if the position of that is exact; 0 if nothing may.
    pub(crate) keep_m: f64,
    /// Its tool to neutralise items, if it has one.
    pub(crate) charge: Option<Tool>,
    /// Its tool to fence items off, if it has one.
    pub(crate) fence: Option<Tool>,
    pub(crate) capabilities: Arc<[u8]>,
}

impl Ability {
    /// Why the robot can never serve a goal with the charges that it has left, if it cannot.
    pub(crate) fn lacks(&self, task: &Task, charges: Option<u32>) -> Option<Reason> {
        let has = task.capability == 0 || self.capabilities.contains(&task.capability);
        let needs_charge = task.work.manner().effect == Some(Effect::Neutralise);
        let can = !needs_charge || self.charge.is_some() && charges != Some(0);
        (!has || !can).then_some(Reason::Capability)
    }

    /// Time that the work at a goal takes.
    pub(crate) fn work_s(&self, task: &Task) -> f64 {
        let search_m = if self.sweeps(task) {
            self.lanes.length_m(task)
        } else {
            0.0
        };
        let tool = match task.work.manner().effect {
            Some(Effect::Neutralise) => self.charge,
            Some(Effect::Isolate) => self.fence,
            None => None,
        };
        let tool_s = tool.map_or(0.0, |tool| tool.duration_s);
        f64::from(task.service_s) + tool_s + self.travel_s(search_m)
    }

    /// Whether it drives lanes through the area of a goal: of a search, and of a mark whose uncertain
    /// position it does not see from one place.
    pub(crate) fn sweeps(&self, task: &Task) -> bool {
        let manner = task.work.manner();
        let is_beyond_view = self.ahead_m > 0.0 && self.uncertain_m(task) > self.ahead_m / 2.0;
        manner.covers_area || manner.is_at_item && is_beyond_view
    }

    /// Distance from a mark at which it sees the whole area in which the marked item may be; without an item
    /// detector, that of the goal.
    pub(crate) fn look_from_m(&self, task: &Task) -> f64 {
        if self.ahead_m <= 0.0 {
            return task.radius_m.into();
        }
        let from_m = (self.ahead_m - self.uncertain_m(task)).max(self.ahead_m / 2.0);
        from_m.max(self.within_reach_m(self.ahead_m))
    }

    /// Whether it fences off the items that it confirms, with the charges that it has left: it cannot neutralise them.
    pub(crate) fn isolates(&self, charges: Option<u32>) -> bool {
        self.fence.is_some() && (self.charge.is_none() || charges == Some(0))
    }

    /// Distance from an item at which a tool reaches it.
    pub(crate) fn act_from_m(&self, tool: Option<&Tool>) -> f64 {
        let range_m = tool.map_or(0.0, |tool| tool.range_m);
        let from_m = (range_m - DEVIATIONS * self.position_noise_m).max(range_m / 2.0);
        from_m.max(self.within_reach_m(range_m))
    }

    /// A distance within a range at which it is safe; less if there is none.
    fn within_reach_m(&self, range_m: f64) -> f64 {
        if self.keep_m > 0.0 {
            (range_m - WORK_REACH_M).min(self.keep_m + ROOM_M)
        } else {
            0.0
        }
    }

    /// How near it drives to a place at which it has to be within a distance.
    pub(crate) fn approach_m(&self, task: &Task, near_m: f64) -> f64 {
        if !task.work.manner().is_at_item {
            return near_m;
        }
        (APPROACH * near_m).max(near_m.min(self.within_reach_m(f64::INFINITY)))
    }

    /// Its maximum speed at a distance from a place at which it has to be within another. Where what is marked may be nearer
    /// than it is safe, the robot is slow enough to detect it before.
    pub(crate) fn speed_at_m_s(&self, task: &Task, [away_m, near_m]: [f64; 2]) -> f64 {
        let uncertain_m = self.uncertain_m(task);
        let is_exposed = self.is_at_hazard(task) && near_m < self.keep_m + uncertain_m;
        let is_in_view = away_m < near_m + uncertain_m + self.ahead_m;
        if is_exposed && is_in_view {
            let seen_m = (self.ahead_m - self.keep_m).max(0.0);
            self.speed_m_s
                .min((seen_m / LOOK_S).max(MIN_CLOSE_SPEED_M_S))
        } else {
            self.speed_m_s
        }
    }

    /// Whether it looks at, or acts on, an item there that may destroy it.
    pub(crate) fn is_at_hazard(&self, task: &Task) -> bool {
        self.keep_m > 0.0 && task.work.manner().is_at_item
    }

    /// How far a marked item may be from the mark, by the errors of the mark and of its own position.
    pub(crate) fn uncertain_m(&self, task: &Task) -> f64 {
        libm::hypot(f64::from(task.radius_m), DEVIATIONS * self.position_noise_m)
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
        let is_seen = !task.work.manner().covers_area || away_m + radius_m <= self.all_round_m;
        away_m <= radius_m && is_seen
    }
}

/// The state of a robot in a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'s> {
    pub(crate) percept: &'s Percept,
    pub(crate) body: &'s Body,
    /// Its beliefs, if it has any.
    pub(crate) beliefs: Option<&'s Beliefs>,
    /// Its map, if it has one.
    pub(crate) map: Option<&'s Map>,
    /// Its position, if known, and the standard deviation of that along each axis.
    pub(crate) at: Option<Point>,
    pub(crate) deviation_m: f64,
    pub(crate) elapsed_s: f64,
    /// Remaining time of the battery, and its charge if known.
    pub(crate) battery_s: f64,
    pub(crate) charge: Option<f64>,
}
