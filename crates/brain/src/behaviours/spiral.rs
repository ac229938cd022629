//! Searching in a spiral.

use super::goal_behaviour::GoalBehaviour;
use super::lawnmower::swath_m;
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::body::Body;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::perception::sector::direction;
use crate::situation::Situation;
use alloc::boxed::Box;
use base::geometry::Point;
use core::f64::consts::TAU;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Overlap of neighbouring turns, as a fraction of the swath.
const OVERLAP: f64 = 0.1;

/// Searches in a spiral around where it began, or around a given position, until nothing of the
/// field is left outside; then again from the centre. Parts outside the field are skipped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Spiral {
    /// Centre, in metres. Without it, where the robot is when it begins.
    pub around_m: Option<Point>,
    /// Distance between turns, in metres. Without it, the width that the detector sees, less a
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

impl Default for Spiral {
    fn default() -> Self {
        Self {
            around_m: None,
            width_m: None,
            speed_m_s: None,
            value: 1.0,
        }
    }
}

/// [`Spiral`] in a body.
#[derive(Debug, Clone)]
pub(crate) struct Ready {
    around: Option<Point>,
    width_m: f64,
    destination: Destination,
}

/// Progress of a robot on its spiral.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Winding {
    middle: Point,
    /// Distance along the spiral.
    along_m: f64,
    goal: Option<GoalPlace>,
}

impl Winding {
    fn new(middle: Point) -> Self {
        Self {
            middle,
            along_m: 0.0,
            goal: None,
        }
    }
}

impl Ready {
    pub(super) fn new(spec: &Spiral, body: &Body) -> Self {
        let (width_m, _) = swath_m(body);
        let width_m = spec.width_m.unwrap_or(width_m * (1.0 - OVERLAP));
        let width_m = width_m.max(2.0 * body.radius_m);
        Self {
            around: spec.around_m,
            width_m,
            destination: Destination {
                id: GoalId::default(),
                at: Point::default(),
                tolerance_m: width_m / 4.0,
                max_deviation_m: f64::INFINITY,
                is_at_hazard: false,
                max_speed_m_s: spec.speed_m_s.unwrap_or(body.max_speed_m_s),
                value: spec.value,
            },
        }
    }

    /// The point at a distance along an Archimedean spiral, for which approximately length = width /
    /// (4 pi) x angle^2, and the angle there.
    fn place(&self, middle: Point, along_m: f64) -> (Point, f64) {
        let angle_rad = libm::sqrt(2.0 * TAU * along_m / self.width_m);
        let radius_m = self.width_m * angle_rad / TAU;
        let angle_rad = libm::fmod(angle_rad, TAU);
        (middle.plus(direction(angle_rad).times(radius_m)), radius_m)
    }

    /// The next point inside the field that is not within the tolerance.
    fn next(&self, winding: &mut Winding, situation: &Situation) -> Option<Point> {
        let Winding {
            middle, along_m, ..
        } = winding;
        let beliefs = situation.beliefs?;
        let (at, field) = (beliefs.pose()?.at, &beliefs.map.as_ref()?.field);
        let size = field.size();
        for _ in 0..100_000 {
            let (place, radius_m) = self.place(*middle, *along_m);
            if radius_m > size.length() {
                *along_m = 0.0;
                return None;
            }
            let inside = field.nearest(place);
            let is_near = inside.to(place).length() <= self.width_m / 2.0;
            if is_near && at.to(inside).length() > self.destination.tolerance_m {
                return Some(inside);
            }
            *along_m += self.width_m / 2.0;
        }
        None
    }
}

impl GoalBehaviour for Ready {
    type Progress = Winding;

    fn destination(&self) -> &Destination {
        &self.destination
    }

    fn goal(&self, winding: &mut Option<Box<Winding>>, situation: &Situation) -> Option<Proposal> {
        let at = situation.beliefs?.pose()?.at;
        let middle = self.around.unwrap_or(at);
        let winding = winding.get_or_insert_with(|| Box::new(Winding::new(middle)));
        let to = situation.goal_at(self.next(winding, situation)?, winding.goal);
        winding.goal = Some(to);
        Some(self.drive_to(to))
    }

    fn judged(&self, winding: &mut Winding, verdict: Verdict) {
        if verdict == Verdict::Impossible {
            winding.along_m += self.width_m / 2.0;
        }
    }
}
