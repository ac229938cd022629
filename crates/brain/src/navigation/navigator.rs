//! The navigator drives a robot to a destination.
//!
//! The [path](super::path) leads around known obstacles; its next waypoint is the target of this
//! step. Of the [headings](super::reachable) around the robot, the navigator takes the one that
//! gets it nearest to the target, and [gives way](super::shunting) if the robot is blocked. Keeping
//! clear of [other robots](super::traffic) comes last.
//!
//! Both the path and the headings keep clear of [hazards](super::hazards). A path to a goal inside a
//! hazard ends outside, within the tolerance of the goal; without such an end, there is no path.

use super::hazards::Hazards;
use super::path::{Wavefront, is_connected};
use super::reachable::{Reachable, approach_speed_m_s};
use super::shunting::{Shunting, Step};
use super::traffic::Traffic;
use crate::goals::fitness::PROGRESS_M;
use crate::goals::proposal::Destination;
use crate::io::command::Motion;
use crate::io::goal_id::GoalPlace;
use crate::perception::beliefs::pose::Pose;
use crate::perception::beliefs::{Beliefs, Map, static_hits};
use crate::perception::rays::Ray;
use crate::situation::Situation;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use core::f64::consts::FRAC_PI_3;

/// A plan is renewed after this time, in seconds.
const PLAN_LIFETIME_S: f64 = 1.0;

/// Clearance beside occupied cells, as a fraction of the cell size.
const CLEARANCE: f64 = 0.35;

/// Where no path has that clearance, an obstacle may lie this much farther away than the centre of
/// its cell, as a fraction of the cell size.
const TIGHT_CLEARANCE: f64 = 0.5;

/// At an item that may destroy it, a robot stops at most this far inside the tolerance of its goal, in metres.
const STOP_AT_HAZARD_M: f64 = 0.1;

/// The path of one robot, and its memory for driving along it.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Navigator {
    pub(crate) reachable: Reachable,
    pub(crate) traffic: Traffic,
    shunting: Shunting,
    #[hashed(skip)]
    hits: Vec<Ray>,
    #[hashed(skip)]
    hazards: Hazards,
    #[hashed(skip)]
    wavefront: Wavefront,
    plan: Option<Plan>,
    /// Whether the goal has been given up before: where no path is known, obstacles that are stale are
    /// observed again.
    #[hashed(skip)]
    is_retry: bool,
    added_m: f64,
    /// The target of the last step, relative to the robot's front: bearing (radians) and distance
    /// (metres).
    pub(crate) target: Option<[f64; 2]>,
}

// The others are the scratch memory of one step.

#[derive(Debug, Clone, Copy, PartialEq)]
struct Plan {
    goal: GoalPlace,
    /// Where the path ends: the goal, or a place near it if the goal is in a hazard.
    end: Point,
    /// The next waypoint; `None` if there is no path.
    waypoint: Option<Point>,
    /// Length of the path beyond the waypoint.
    beyond_m: f64,
    age_s: f64,
    /// [`Occupancy::changes`](crate::perception::beliefs::occupancy::Occupancy::changes) of the map
    /// that it was made on.
    map_changes: u32,
    /// The same for [`Occupancy::discoveries`](crate::perception::beliefs::occupancy::Occupancy::discoveries).
    discoveries: u32,
}

impl Hashed for Plan {
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            goal,
            end,
            waypoint,
            beyond_m,
            age_s,
            map_changes,
            discoveries,
        } = self;
        (*goal, *waypoint).add_to(hash);
        [*beyond_m, *age_s].add_to(hash);
        [*map_changes, *discoveries].add_to(hash);
        if *end != goal.at {
            end.add_to(hash);
        }
    }
}

impl Plan {
    /// Length of the path from a position; the straight line if no path is known.
    fn remaining_m(&self, at: Point) -> f64 {
        let waypoint = self.waypoint.unwrap_or(self.goal.at);
        at.to(waypoint).length() + self.beyond_m
    }

    /// By how much the path from a position is longer than that of an older plan, if the robot has
    /// discovered an occupied cell since then; less than 0 if it is shorter.
    fn added_m(&self, older: &Self, at: Point) -> f64 {
        let has_paths = self.waypoint.is_some() && older.waypoint.is_some();
        let added_m = self.remaining_m(at) - older.remaining_m(at);
        let is_longer = added_m > PROGRESS_M && self.discoveries != older.discoveries;
        if self.goal == older.goal && has_paths && (is_longer || added_m < 0.0) {
            added_m
        } else {
            0.0
        }
    }

    fn is_straight(&self) -> bool {
        self.waypoint == Some(self.end)
    }

    /// Whether the next waypoint has to be determined again.
    fn is_due(&self, at: Point, cell_m: f64) -> bool {
        let is_near = |waypoint: Point| at.to(waypoint).length() < 2.0 * cell_m;
        let has_reached = !self.is_straight() && self.waypoint.is_some_and(is_near);
        has_reached || self.age_s >= PLAN_LIFETIME_S
    }
}

/// Where the next waypoint of a new plan comes from.
enum Source {
    /// No known obstacle lies before the end of the path, which is the waypoint.
    StraightLine,
    /// The distances of the last search, which are still valid.
    LastSearch,
    /// A new search.
    NewSearch,
}

impl Navigator {
    /// The motion towards a destination, which may be tried again; zero without a pose or a path.
    pub(crate) fn drive_to(
        &mut self,
        (destination, is_retry): (&Destination, bool),
        situation: &Situation,
        beliefs: &Beliefs,
    ) -> Motion {
        self.is_retry = is_retry;
        let Some(pose) = beliefs.pose() else {
            return Motion::default();
        };
        self.hazards.update(beliefs, situation.body);
        if destination.is_at_hazard {
            self.hazards.admit(destination.at, destination.tolerance_m);
        }
        let goal = destination.goal();
        let waypoint = match &beliefs.map {
            Some(map) => self.next_waypoint(destination, &pose, map, situation),
            None => Some(goal.at),
        };
        let Some(waypoint) = waypoint else {
            return Motion::default();
        };
        static_hits(
            &beliefs.others,
            situation.rings,
            situation.percept,
            &mut self.hits,
        );
        let step = Step {
            goal: goal.at,
            target: pose.in_own_frame(waypoint),
            remaining_m: self.remaining_m(pose.at, goal),
            turned_rad: situation.turned_rad,
            elapsed_s: situation.elapsed_s,
            max_speed_m_s: situation.body.max_speed_m_s,
            hits: &self.hits,
            movers: &beliefs.others.movers,
        };
        let target = self.shunting.redirect(&step, situation.random_words());
        let is_uncertain = destination.is_uncertain(pose.at, pose.deviation_m);
        if is_uncertain && !self.shunting.is_yielding() {
            // It waits for more readings.
            return Motion::default();
        }
        let max_m_s = self.max_speed_m_s(destination, step.remaining_m, situation);
        self.steer(target, max_m_s, situation, (beliefs, &pose))
    }

    /// The maximum speed with which the robot stops at its destination, unless it gives way.
    fn max_speed_m_s(
        &self,
        destination: &Destination,
        remaining_m: f64,
        situation: &Situation,
    ) -> f64 {
        let tolerance_m = self.end_tolerance_m(destination);
        let inside_m = if destination.is_at_hazard {
            (tolerance_m / 2.0).min(STOP_AT_HAZARD_M)
        } else {
            tolerance_m / 2.0
        };
        let stop_within_m = remaining_m - (tolerance_m - inside_m);
        if self.shunting.is_yielding() {
            destination.max_speed_m_s
        } else {
            destination
                .max_speed_m_s
                .min(stopping_speed_m_s(stop_within_m, situation))
        }
    }

    /// Distance to the end of the path within which the goal is reached.
    fn end_tolerance_m(&self, destination: &Destination) -> f64 {
        let goal = destination.goal();
        let plan = self.plan.filter(|plan| plan.goal == goal);
        plan.map_or(destination.tolerance_m, |plan| {
            destination.tolerance_m - goal.at.to(plan.end).length()
        })
    }

    /// The goal of the current plan if no path to it is known.
    pub(crate) fn unreachable_goal(&self) -> Option<GoalPlace> {
        let plan = self.plan.filter(|plan| plan.waypoint.is_none())?;
        Some(plan.goal)
    }

    /// Length of the path from a position to a goal; the straight line if no path is known.
    pub(crate) fn remaining_m(&self, at: Point, goal: GoalPlace) -> f64 {
        let plan = self.plan.filter(|plan| plan.goal == goal);
        plan.map_or_else(|| at.to(goal.at).length(), |plan| plan.remaining_m(at))
    }

    /// By how much new paths since the last call are longer because of a cell that was discovered to be
    /// occupied, or less than 0 if they are shorter.
    pub(crate) fn take_added_m(&mut self) -> f64 {
        core::mem::take(&mut self.added_m)
    }

    pub(crate) fn discard_plan(&mut self) {
        self.plan = None;
    }

    /// The next waypoint on the path: its end if no known obstacle or hazard lies before it.
    fn next_waypoint(
        &mut self,
        destination: &Destination,
        pose: &Pose,
        map: &Map,
        situation: &Situation,
    ) -> Option<Point> {
        let goal = destination.goal();
        let plan = self.plan.filter(|plan| plan.goal == goal);
        if let Some(plan) = plan.filter(|plan| !plan.is_due(pose.at, map.field.cell_m)) {
            return self.keep(plan, situation.elapsed_s);
        }
        let end = self.end(destination, plan, pose.at, map);
        let waypoint = end.and_then(|end| match self.waypoint_source(end, plan, pose.at, map) {
            Source::StraightLine => Some(end),
            Source::LastSearch => self.wavefront.waypoint(&map.field, &map.occupancy, pose.at),
            Source::NewSearch => self.search(end, pose.at, map, situation.body.radius_m),
        });
        let end = end.unwrap_or(goal.at);
        let plan = Plan {
            goal,
            end,
            waypoint,
            beyond_m: self.beyond_m(waypoint, end, map),
            age_s: 0.0,
            map_changes: map.occupancy.changes,
            discoveries: map.occupancy.discoveries,
        };
        let older = self.plan.replace(plan);
        self.added_m += older.map_or(0.0, |older| plan.added_m(&older, pose.at));
        waypoint
    }

    /// Where a path ends: at its goal, or outside of hazards within the tolerance of the goal. An end that still is
    /// outside is kept.
    fn end(
        &self,
        destination: &Destination,
        plan: Option<Plan>,
        at: Point,
        map: &Map,
    ) -> Option<Point> {
        let goal = destination.at;
        if !self.hazards.contain(goal) {
            return Some(goal);
        }
        let moved = plan.filter(|plan| plan.waypoint.is_some() && plan.end != goal);
        let kept = moved.map(|plan| plan.end);
        let kept = kept.filter(|end| !self.hazards.contain(*end));
        let is_open = |end: Point| {
            let cell = map.field.cell(end);
            cell.is_some_and(|cell| !map.occupancy.is_occupied(cell))
                && is_connected(&map.field, &map.occupancy, end, goal)
        };
        let (near, hazards) = ((goal, destination.tolerance_m), &self.hazards);
        kept.or_else(|| hazards.end(near, at, is_open))
    }

    fn waypoint_source(&self, end: Point, plan: Option<Plan>, at: Point, map: &Map) -> Source {
        let is_clear = self.hazards.are_clear_between(at, end);
        if is_clear && map.occupancy.is_free_between(&map.field, at, end) {
            return Source::StraightLine;
        }
        let is_valid = plan.is_some_and(|plan| {
            plan.map_changes == map.occupancy.changes && plan.end == end && !plan.is_straight()
        });
        let has_same = is_valid && self.wavefront.avoids(&self.hazards);
        if has_same && self.wavefront.covers(&map.field, at) {
            Source::LastSearch
        } else {
            Source::NewSearch
        }
    }

    fn keep(&mut self, plan: Plan, elapsed_s: f64) -> Option<Point> {
        self.plan = Some(Plan {
            age_s: plan.age_s + elapsed_s,
            ..plan
        });
        plan.waypoint
    }

    /// The first waypoint of a new path: one with clearance on both sides, or else one through
    /// which the robot may just fit, since an obstacle need not fill its whole cell. If there is neither, a
    /// goal that is tried again is looked for behind stale obstacles.
    fn search(&mut self, goal: Point, at: Point, map: &Map, radius_m: f64) -> Option<Point> {
        let cell_m = map.field.cell_m;
        let here = map.field.nearest_cell(at);
        let clearances_m = [
            (radius_m + CLEARANCE * cell_m, true),
            ((radius_m - TIGHT_CLEARANCE * cell_m).max(0.0), false),
        ];
        let stages: &[bool] = if self.is_retry {
            &[false, true]
        } else {
            &[false]
        };
        stages.iter().find_map(|passes_stale| {
            self.wavefront.pass_stale(*passes_stale);
            clearances_m.into_iter().find_map(|(clearance_m, is_wide)| {
                let known = (&map.field, &map.occupancy);
                self.wavefront.avoid(&self.hazards, is_wide);
                self.wavefront
                    .expand(known, goal, clearance_m, |cell, _| cell != here);
                self.wavefront.waypoint(&map.field, &map.occupancy, at)
            })
        })
    }

    /// Length of the path from its next waypoint to the goal.
    fn beyond_m(&self, waypoint: Option<Point>, goal: Point, map: &Map) -> f64 {
        let Some(waypoint) = waypoint.filter(|waypoint| *waypoint != goal) else {
            return 0.0;
        };
        let cell = map.field.nearest_cell(waypoint);
        let by_cells_m = self.wavefront.cell_distance_m(&map.field, cell);
        // If the robot does not fit into the goal cell, the wavefront starts beside it.
        by_cells_m
            .unwrap_or_default()
            .max(waypoint.to(goal).length())
    }

    /// The motion along the best heading to a target, which is relative to the robot's front.
    fn steer(
        &mut self,
        target: Point,
        max_m_s: f64,
        situation: &Situation,
        (beliefs, pose): (&Beliefs, &Pose),
    ) -> Motion {
        let body = situation.body;
        let speed_m_s = body.max_speed_m_s.min(max_m_s.max(0.1));
        let movers = &beliefs.others.movers;
        self.reachable
            .update(&self.hits, movers, (body.radius_m, speed_m_s));
        self.hazards.limit(&mut self.reachable, pose);
        let (bearing_rad, distance_m) = (libm::atan2(target.y, target.x), target.length());
        self.target = Some([bearing_rad, distance_m]);
        let choice = self.reachable.best(bearing_rad, distance_m);
        let turn_rad = choice.bearing_rad;
        let aligned = (1.0 - turn_rad.abs() / FRAC_PI_3).max(0.0);
        let free_m = choice.free_m.min(self.reachable.ahead_m());
        Motion {
            speed_m_s: max_m_s.min(approach_speed_m_s(free_m)) * aligned,
            turn_rate_rad_s: situation.turn_rate_rad_s(turn_rad, body.period_s),
        }
    }
}

/// The maximum speed from which the robot stops within a distance.
pub(crate) fn stopping_speed_m_s(distance_m: f64, situation: &Situation) -> f64 {
    let braking = 0.9 * situation.body.max_acceleration_m_s2;
    if braking.is_finite() {
        libm::sqrt(2.0 * braking * distance_m.max(0.0))
    } else {
        distance_m.max(0.0) / situation.body.period_s
    }
}
