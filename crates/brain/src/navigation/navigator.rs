//! How to get to an aim: the *adapter* of a mind.
//!
//! The [path](super::path) leads around what is known to be filled; the next place on it is what the robot
//! turns to. Of all that it can [reach](super::reachable) from here it takes what is best for that, or [gives
//! way](super::shunting) if it gets nowhere. Last, it keeps out of [others' way](super::traffic).

use super::path::Wave;
use super::reachable::{Reachable, unhurried_m_s};
use super::shunting::{Shunting, Step};
use super::traffic::Traffic;
use crate::goals::proposal::Destination;
use crate::io::command::Motion;
use crate::perception::beliefs::pose::Pose;
use crate::perception::beliefs::{Beliefs, Map, standing};
use crate::perception::rays::Ray;
use crate::perception::situation::Situation;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::FRAC_PI_3;

/// A path is looked over after so long, in seconds.
const LOOKED_OVER_S: f64 = 1.0;

/// Room beside what is filled, as a share of a cell's width.
const CELL_ROOM: f64 = 0.35;

/// Where there is no other way, what fills a cell may be so much farther off than its middle, as a share of
/// a cell's width.
const TIGHT_ROOM: f64 = 0.5;

/// What one robot remembers of its way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Navigator {
    pub(crate) reachable: Reachable,
    pub(crate) traffic: Traffic,
    shunting: Shunting,
    hits: Vec<Ray>,
    wave: Wave,
    plan: Option<Plan>,
    /// The place that it turned to in the last step, from its front: its bearing and how far it was.
    pub(crate) turned_to: Option<[f64; 2]>,
}

/// A way that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plan {
    to: Point,
    /// The next place on it; `None` if there is no way.
    next: Option<Point>,
    /// The way from there on.
    beyond_m: f64,
    age_s: f64,
    /// Of the map, when it was found.
    changes: u32,
}

impl Navigator {
    /// The motion towards an aim; to stand, if it does not know where it is or there is no way.
    pub(crate) fn towards(
        &mut self,
        aim: &Destination,
        situation: &Situation,
        beliefs: &Beliefs,
    ) -> Motion {
        let Some(pose) = beliefs.pose() else {
            return Motion::default();
        };
        let next = match &beliefs.map {
            Some(map) => self.next(aim.to, &pose, map, situation),
            None => Some(aim.to),
        };
        let Some(next) = next else {
            return Motion::default();
        };
        standing(beliefs, situation.rings, situation.percept, &mut self.hits);
        let step = Step {
            aim: aim.to,
            way: pose.own(next),
            left_m: self.left_m(pose.at, aim.to),
            turned_rad: situation.turned_rad,
            period_s: situation.body.period_s,
            max_speed_m_s: situation.body.max_speed_m_s,
            hits: &self.hits,
            movers: &beliefs.others.movers,
        };
        let way = self.shunting.instead(&step, situation.dice());
        let left_m = step.left_m - aim.within_m / 2.0;
        let most_m_s = if self.shunting.gives_way() {
            aim.speed_m_s
        } else {
            aim.speed_m_s.min(stopping_m_s(left_m, situation))
        };
        self.take(way, most_m_s, situation, beliefs)
    }

    /// A place to which there is no way as far as it knows.
    pub(crate) fn closed(&self) -> Option<Point> {
        let plan = self.plan.filter(|plan| plan.next.is_none())?;
        Some(plan.to)
    }

    /// The way left from a place to an aim, as far as it knows.
    pub(crate) fn left_m(&self, at: Point, aim: Point) -> f64 {
        let plan = self.plan.filter(|plan| plan.to == aim);
        let known = plan.and_then(|plan| Some((plan.next?, plan.beyond_m)));
        let (next, beyond_m) = known.unwrap_or((aim, 0.0));
        at.to(next).length() + beyond_m
    }

    /// Forgets the way.
    pub(crate) fn find_anew(&mut self) {
        self.plan = None;
    }

    /// The next place on the way: the aim itself if nothing stands before it.
    fn next(&mut self, to: Point, pose: &Pose, map: &Map, situation: &Situation) -> Option<Point> {
        let plan = self.plan.filter(|plan| plan.to == to);
        let period_s = situation.body.period_s;
        let (is_old, is_there) = match plan {
            None => (true, true),
            Some(plan) => {
                let near_m = 2.0 * map.field.cell_m;
                let is_there = plan
                    .next
                    .is_some_and(|next| pose.at.to(next).length() < near_m);
                (
                    plan.age_s >= LOOKED_OVER_S,
                    is_there && plan.next != Some(to),
                )
            }
        };
        if let (Some(plan), false) = (plan, is_old || is_there) {
            self.plan = Some(Plan {
                age_s: plan.age_s + period_s,
                ..plan
            });
            return plan.next;
        }
        let is_straight = map.filled.is_free_between(&map.field, pose.at, to);
        let next = if is_straight {
            Some(to)
        } else {
            let is_known = plan.is_some_and(|plan| {
                let is_the_same = plan.changes == map.filled.changes && plan.next != Some(to);
                is_the_same && self.wave.knows(&map.field, pose.at)
            });
            if is_known {
                self.wave.ahead(&map.field, &map.filled, pose.at)
            } else {
                self.found(to, pose, map, situation.body.radius_m)
            }
        };
        let beyond_m = next.filter(|next| *next != to).map(|next| {
            let cell = map.field.nearest_cell(next);
            let by_cells_m = self.wave.cell_distance_m(&map.field, cell);
            // A wave to where the body does not fit begins beside it.
            by_cells_m.unwrap_or_default().max(next.to(to).length())
        });
        self.plan = Some(Plan {
            to,
            next,
            beyond_m: beyond_m.unwrap_or_default(),
            age_s: 0.0,
            changes: map.filled.changes,
        });
        next
    }

    /// The next place on the way that is found anew: one with room on both sides, or else one where it may
    /// just fit, since what fills a cell need not fill all of it.
    fn found(&mut self, to: Point, pose: &Pose, map: &Map, radius_m: f64) -> Option<Point> {
        let cell_m = map.field.cell_m;
        let here = map.field.nearest_cell(pose.at);
        let rooms_m = [
            radius_m + CELL_ROOM * cell_m,
            (radius_m - TIGHT_ROOM * cell_m).max(0.0),
        ];
        rooms_m.into_iter().find_map(|room_m| {
            let known = (&map.field, &map.filled);
            self.wave.run(known, to, room_m, |cell, _| cell != here);
            self.wave.ahead(&map.field, &map.filled, pose.at)
        })
    }

    /// Goes a way from its front, as well as that can be done.
    fn take(
        &mut self,
        way: Point,
        most_m_s: f64,
        situation: &Situation,
        beliefs: &Beliefs,
    ) -> Motion {
        let body = situation.body;
        let speed_m_s = body.max_speed_m_s.min(most_m_s.max(0.1));
        let movers = &beliefs.others.movers;
        self.reachable
            .look(&self.hits, movers, (body.radius_m, speed_m_s));
        let (aim_rad, away_m) = (libm::atan2(way.y, way.x), way.length());
        self.turned_to = Some([aim_rad, away_m]);
        let choice = self.reachable.best(aim_rad, away_m);
        let turn_rad = choice.bearing_rad;
        let aligned = (1.0 - turn_rad.abs() / FRAC_PI_3).max(0.0);
        let free_m = choice.free_m.min(self.reachable.ahead_m());
        Motion {
            speed_m_s: most_m_s.min(unhurried_m_s(free_m)) * aligned,
            turn_rate_rad_s: turn_rad / body.period_s,
        }
    }
}

/// The greatest speed from which it stops within a distance.
pub(crate) fn stopping_m_s(left_m: f64, situation: &Situation) -> f64 {
    let braking = 0.9 * situation.body.max_acceleration_m_s2;
    if braking.is_finite() {
        libm::sqrt(2.0 * braking * left_m.max(0.0))
    } else {
        left_m.max(0.0) / situation.body.period_s
    }
}
