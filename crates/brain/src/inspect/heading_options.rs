//! The utility of the headings around a robot.

use crate::navigation::navigator::Navigator;
use crate::navigation::reachable::{COURSES, bearing_rad, utility};
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The headings that a robot considered, and which of them it took.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingOptions {
    /// The next place on its path, relative to the robot's front.
    pub to: Point,
    /// Index in `courses` of the one that it took.
    pub taken: u32,
    /// All around, the first straight ahead, anticlockwise.
    pub courses: Vec<HeadingOption>,
}

/// A heading, and its utility.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingOption {
    /// Relative to the robot's front, from -pi to pi.
    pub bearing_rad: f64,
    /// Free distance, as far as the robot looks ahead.
    pub free_m: f64,
    /// The place that it would reach, relative to the robot's front.
    pub at: Point,
    /// Utility of that place: minus the distance left from there, minus the cost of turning there,
    /// in metres.
    pub utility: f64,
}

impl HeadingOptions {
    /// Of the last step; `None` if the robot did not navigate in it.
    pub(crate) fn of(way: &Navigator) -> Option<Self> {
        let [aim_rad, away_m] = way.turned_to?;
        let to = crate::perception::sector::direction(aim_rad).times(away_m);
        let reachable = &way.reachable;
        let course = |course| {
            let at = reachable.reached(course, away_m);
            HeadingOption {
                bearing_rad: bearing_rad(course),
                free_m: reachable.free_m[course],
                at,
                utility: utility(course, at.to(to).length_squared()),
            }
        };
        let taken = reachable.best_course(aim_rad, away_m);
        Some(Self {
            to,
            taken: u32::try_from(taken).unwrap_or(u32::MAX),
            courses: (0..COURSES).map(course).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::rays::Ray;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_course_that_is_taken_is_worth_most(
            hits in proptest::collection::vec((-PI..PI, 0.05_f64..6.0), 0..12),
            aim_rad in -PI..PI, away_m in 0.0_f64..8.0,
        ) {
            let hits: Vec<Ray> = hits.iter().map(|(bearing, range)| Ray::new(*bearing, *range)).collect();
            let mut way = Navigator::default();
            prop_assert!(HeadingOptions::of(&way).is_none());
            way.reachable.look(&hits, &[], (0.25, 1.0));
            way.turned_to = Some([aim_rad, away_m]);
            let told = HeadingOptions::of(&way).unwrap();
            let taken = told.courses[told.taken as usize];
            let most = told.courses.iter().map(|course| course.utility).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(taken.utility >= most - 1e-9, "{told:?}");
            let choice = way.reachable.best(aim_rad, away_m);
            prop_assert_eq!(choice.free_m.to_bits(), taken.free_m.to_bits());
            for course in told.courses {
                prop_assert!(course.at.length() <= course.free_m.min(away_m) + 1e-9);
            }
        }
    }
}
