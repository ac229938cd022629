//! Searching lane by lane.

use super::goal_behaviour::GoalBehaviour;
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::{Body, Detector};
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::perception::beliefs::field::Field;
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use core::f64::consts::{FRAC_PI_2, TAU};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Neighbouring lanes overlap by this share of what is seen from them.
const OVERLAP: f64 = 0.1;

/// Searches lane by lane, back and forth, like mowing a lawn. Robots of its kind share the lanes:
/// each takes an equal part of the whole path. At the end it starts again, with lanes across the
/// previous ones: what they missed, the others may detect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Lawnmower {
    /// Distance between lanes, in metres. Without it, the width that the detector sees, less a
    /// tenth.
    #[schemars(range(min = 0.1, max = 10_000.0))]
    pub width_m: Option<f64>,
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
    /// Value of searching, relative to other behaviours.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub value: f64,
}

impl Default for Lawnmower {
    fn default() -> Self {
        Self {
            width_m: None,
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// Bound on the number of corners.
const MAX_CORNERS: usize = 100_000;

/// [`Lawnmower`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    width_m: f64,
    inset_m: f64,
    destination: Destination,
}

/// Progress of a robot on its part of the lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    /// Index of the part, and number of parts.
    part: [u32; 2],
    /// Number of complete passes; lanes of every second pass run across the previous ones.
    passes: u32,
    /// Corners visited or skipped in this pass.
    visited: u32,
    /// The next corner, once it is computed.
    to: Option<Point>,
    /// The goal of being there.
    goal: Option<GoalPlace>,
}

impl Ready {
    pub(super) fn new(spec: &Lawnmower, body: &Body) -> Self {
        let (width_m, range_m) = swath_m(body);
        let width_m = spec.width_m.unwrap_or(width_m * (1.0 - OVERLAP));
        Self {
            width_m: width_m.max(2.0 * body.radius_m),
            inset_m: (range_m / 2.0).min(width_m / 2.0).max(1.5 * body.radius_m),
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: (0.1 * width_m).clamp(0.2, 2.0),
                max_deviation_m: f64::INFINITY,
                is_at_hazard: false,
                max_speed_m_s: spec.speed_m_s.unwrap_or(body.max_speed_m_s),
                value: spec.value,
            },
        }
    }
}

impl Progress {
    fn of(part: [u32; 2]) -> Self {
        Self {
            part,
            passes: 0,
            visited: 0,
            to: None,
            goal: None,
        }
    }

    fn advance(&mut self) {
        self.visited = self.visited.wrapping_add(1);
        self.to = None;
    }
}

impl Ready {
    /// The next corner of a robot.
    fn place(&self, progress: &mut Progress, field: &Field) -> Option<Point> {
        // The last corner of a pass is followed by the first of the next pass.
        for _ in 0..2 {
            if progress.to.is_none() {
                let is_across = progress.passes % 2 == 1;
                let track = Track::new(field, [self.width_m, self.inset_m], is_across);
                progress.to = track.place_of_part(progress.part, progress.visited);
            }
            if progress.to.is_some() {
                break;
            }
            (progress.passes, progress.visited) = (progress.passes.wrapping_add(1), 0);
        }
        progress.to
    }
}

/// The width of the strip that the best detector covers while the body drives straight, and its
/// range; default values for a body without a detector.
pub(super) fn swath_m(body: &Body) -> (f64, f64) {
    let strips = body.detectors.iter().map(|detector| {
        let half_rad = (detector.width_rad / 2.0).min(FRAC_PI_2);
        let half_width_m = detector.range_m * crate::perception::sector::direction(half_rad).y;
        (2.0 * half_width_m, detector.range_m)
    });
    let widest = strips.fold(
        (0.0, 0.0),
        |one, other| if other.0 > one.0 { other } else { one },
    );
    if widest.0 > 0.0 { widest } else { (2.0, 1.0) }
}

/// Within this distance, a body detects items in all directions.
pub(super) fn all_round_m(body: &Body) -> f64 {
    let is_all_round = |detector: &&Detector| detector.width_rad >= TAU - 1e-6;
    let detectors = body.detectors.iter().filter(is_all_round);
    detectors.fold(0.0, |range_m, detector| detector.range_m.max(range_m))
}

/// Within this distance, a body detects items at its front.
pub(super) fn ahead_m(body: &Body) -> f64 {
    let is_ahead = |detector: &&Detector| detector.facing_rad.abs() <= detector.width_rad / 2.0;
    let detectors = body.detectors.iter().filter(is_ahead);
    detectors.fold(0.0, |range_m, detector| detector.range_m.max(range_m))
}

/// The path over a field: lanes along its longer side, from one end to the other.
struct Track {
    field: Field,
    inset_m: f64,
    lanes: u32,
    /// Length of a lane, and distance between lanes.
    lane_m: f64,
    shift_m: f64,
    is_upright: bool,
}

impl Track {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast saturates"
    )]
    fn new(field: &Field, [width_m, inset_m]: [f64; 2], is_across: bool) -> Self {
        let size = field.size();
        let is_upright = (size.y > size.x) != is_across;
        let (long_m, short_m) = if is_upright {
            (size.y, size.x)
        } else {
            (size.x, size.y)
        };
        let lanes = libm::ceil(short_m / width_m).clamp(1.0, 1e6) as u32;
        let inset_m = inset_m.min(long_m / 2.0);
        Self {
            field: *field,
            inset_m,
            lanes,
            lane_m: long_m - 2.0 * inset_m,
            shift_m: short_m / f64::from(lanes),
            is_upright,
        }
    }

    fn length_m(&self) -> f64 {
        f64::from(self.lanes) * self.lane_m + f64::from(self.lanes - 1) * self.shift_m
    }

    /// The point at a distance along the path.
    fn place(&self, along_m: f64) -> Point {
        let period_m = self.lane_m + self.shift_m;
        let lane = libm::floor(along_m / period_m).clamp(0.0, f64::from(self.lanes - 1));
        let rest_m = along_m - lane * period_m;
        let is_back = libm::fmod(lane, 2.0) > 0.5;
        let (on_m, shifted_m) = if rest_m <= self.lane_m {
            (rest_m, 0.0)
        } else {
            (self.lane_m, rest_m - self.lane_m)
        };
        let forth_m = if is_back { self.lane_m - on_m } else { on_m };
        let long_m = self.inset_m + forth_m;
        let short_m = (lane + 0.5) * self.shift_m + shifted_m;
        self.field.place(if self.is_upright {
            [short_m, long_m]
        } else {
            [long_m, short_m]
        })
    }

    /// Distance along the path of the next corner.
    fn corner_after(&self, along_m: f64) -> f64 {
        let period_m = self.lane_m + self.shift_m;
        let periods = libm::floor(along_m / period_m + 1e-9);
        let rest_m = along_m - periods * period_m;
        let is_in_lane = rest_m < self.lane_m - 1e-6;
        periods * period_m + if is_in_lane { self.lane_m } else { period_m }
    }

    /// The `number`-th point of one of several equal parts: its start, its corners, its end. `None`
    /// after that.
    fn place_of_part(&self, [part, parts]: [u32; 2], number: u32) -> Option<Point> {
        let part_m = self.length_m() / f64::from(parts);
        let (from_m, to_m) = (f64::from(part) * part_m, f64::from(part + 1) * part_m);
        let next = |along_m: &f64| Some(self.corner_after(*along_m)).filter(|m| *m < to_m - 1e-6);
        let corners = core::iter::successors(Some(from_m), next).take(MAX_CORNERS);
        let mut places = corners.chain([to_m]);
        places
            .nth(number as usize)
            .map(|along_m| self.place(along_m))
    }
}

impl GoalBehaviour for Ready {
    type Progress = Progress;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(
        &self,
        progress: &mut Option<Box<Progress>>,
        situation: &Situation,
    ) -> Option<Proposal> {
        let beliefs = situation.beliefs?;
        let pose = beliefs.pose()?;
        let field = &beliefs.map.as_ref()?.field;
        let robots = situation.percept.team_size.max(1);
        let part = [situation.percept.id.index % robots, robots];
        let progress = progress.get_or_insert_with(|| Box::new(Progress::of(part)));
        if progress.part != part {
            **progress = Progress::of(part);
        }
        let is_there = |to: Point| pose.at.to(to).length() <= self.destination.tolerance_m;
        if progress.to.is_some_and(is_there) {
            progress.advance();
        }
        let to = situation.goal_at(self.place(progress, field)?, progress.goal);
        progress.goal = Some(to);
        Some(self.drive_to(to))
    }

    fn judged(&self, progress: &mut Progress, verdict: Verdict) {
        if verdict == Verdict::Impossible {
            progress.advance();
        }
    }
}

#[cfg(test)]
mod tests;
