//! The utility of the headings around a robot.

use crate::navigation::navigator::Navigator;
use crate::navigation::reachable::{HEADINGS, bearing_rad, utility};
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The headings that a robot considered, and the one that it chose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingOptions {
    /// The next place on its path, relative to the robot's front.
    pub to: Point,
    /// Index in `headings` of the chosen one.
    pub chosen: u32,
    /// All around, the first straight ahead, anticlockwise.
    pub headings: Vec<HeadingOption>,
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
    pub(crate) fn of(navigator: &Navigator) -> Option<Self> {
        let [target_rad, distance_m] = navigator.target?;
        let to = crate::perception::sector::direction(target_rad).times(distance_m);
        let reachable = &navigator.reachable;
        let option = |heading| {
            let at = reachable.reached(heading, distance_m);
            HeadingOption {
                bearing_rad: bearing_rad(heading),
                free_m: reachable.free_m[heading],
                at,
                utility: utility(heading, at.to(to).length_squared()),
            }
        };
        let chosen = reachable.best_heading(target_rad, distance_m);
        Some(Self {
            to,
            chosen: u32::try_from(chosen).unwrap_or(u32::MAX),
            headings: (0..HEADINGS).map(option).collect(),
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
        fn the_chosen_heading_has_the_highest_utility(
            hits in proptest::collection::vec((-PI..PI, 0.05_f64..6.0), 0..12),
            target_rad in -PI..PI, distance_m in 0.0_f64..8.0,
        ) {
            let hits: Vec<Ray> = hits.iter().map(|(bearing, range)| Ray::new(*bearing, *range)).collect();
            let mut navigator = Navigator::default();
            prop_assert!(HeadingOptions::of(&navigator).is_none());
            navigator.reachable.update(&hits, &[], (0.25, 1.0));
            navigator.target = Some([target_rad, distance_m]);
            let options = HeadingOptions::of(&navigator).unwrap();
            let chosen = options.headings[options.chosen as usize];
            let max = options.headings.iter().map(|option| option.utility).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(chosen.utility >= max - 1e-9, "{options:?}");
            let choice = navigator.reachable.best(target_rad, distance_m);
            prop_assert_eq!(choice.free_m.to_bits(), chosen.free_m.to_bits());
            for option in options.headings {
                prop_assert!(option.at.length() <= option.free_m.min(distance_m) + 1e-9);
            }
        }
    }
}
