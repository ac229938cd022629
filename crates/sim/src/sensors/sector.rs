//! Field of view.

use base::geometry::Point;
use base::trig::sin_cos;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A field of view.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SectorSpec {
    /// Maximum range from the centre of the robot, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub range_m: f64,
    /// Field of view, in degrees.
    #[serde(default = "whole_circle")]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub fov_deg: f64,
    /// Direction of its centre, in degrees anticlockwise from the robot's front.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub facing_deg: f64,
}

pub(super) fn whole_circle() -> f64 {
    360.0
}

/// Whether obstacles block the view by default.
pub(super) fn yes() -> bool {
    true
}

/// Everything within some distance and angle of a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sector {
    pub(crate) range_m: f64,
    pub(crate) width_rad: f64,
    pub(crate) facing_rad: f64,
    /// Unit vector, relative to the robot's front.
    facing: Point,
    /// Cosine of half the width.
    edge: f64,
}

impl Sector {
    pub(crate) fn new(spec: &SectorSpec) -> Self {
        let (width_rad, facing_rad) = (spec.fov_deg.to_radians(), spec.facing_deg.to_radians());
        let (y, x) = sin_cos(facing_rad);
        Self {
            range_m: spec.range_m,
            width_rad,
            facing_rad,
            facing: Point { x, y },
            edge: sin_cos(width_rad / 2.0).1,
        }
    }

    /// Whether it contains the vector `way`, relative to the robot's front.
    #[inline]
    pub(crate) fn holds(&self, way: Point) -> bool {
        let square = way.length_squared();
        if square > self.range_m * self.range_m {
            return false;
        }
        self.width_rad >= std::f64::consts::TAU || self.facing.dot(way) >= self.edge * square.sqrt()
    }

    pub(crate) fn area_m2(&self) -> f64 {
        self.width_rad / 2.0 * self.range_m * self.range_m
    }

    /// A uniformly distributed place in it, from two numbers from 0 to 1.
    pub(crate) fn place(&self, [one, other]: [f64; 2]) -> Point {
        let range_m = self.range_m * one.sqrt();
        let (y, x) = sin_cos(self.facing_rad + (other - 0.5) * self.width_rad);
        Point { x, y }.times(range_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn way(range_m: f64, bearing_deg: f64) -> Point {
        let (y, x) = sin_cos(bearing_deg.to_radians());
        Point { x, y }.times(range_m)
    }

    fn seen(range_m: f64, fov_deg: f64, facing_deg: f64) -> Sector {
        Sector::new(&SectorSpec {
            range_m,
            fov_deg,
            facing_deg,
        })
    }

    proptest! {
        #[test]
        fn a_sector_holds_what_is_in_range_and_in_its_angle(
            range in 0.1..1000.0_f64, width in 0.0..360.0_f64, facing in -180.0..180.0,
            share in 0.0..2.0_f64, off in -180.0..180.0_f64,
        ) {
            prop_assume!((off.abs() - width / 2.0).abs() > 1e-4 && (share - 1.0).abs() > 1e-9);
            let sector = seen(range, width, facing);
            let holds = sector.holds(way(share * range, facing + off));
            prop_assert_eq!(holds, share <= 1.0 && off.abs() <= width / 2.0);
        }

        #[test]
        fn a_place_in_a_sector_is_held_by_it(
            range in 0.1..1000.0_f64, width in 1.0..=360.0_f64, facing in -180.0..180.0,
            one in 1e-6..0.999_999_f64, other in 1e-6..0.999_999_f64,
        ) {
            let sector = seen(range, width, facing);
            prop_assert!(sector.holds(sector.place([one, other])));
        }
    }

    #[test]
    fn a_whole_circle_has_no_edge() {
        let circle = seen(2.0, 360.0, 0.0);
        for step in 0..100_000 {
            let bearing_deg = 179.999 + f64::from(step) * 2e-8;
            assert!(circle.holds(way(1.999_999, bearing_deg)));
        }
        assert!(circle.holds(Point::default()));
        assert!((circle.area_m2() - 4.0 * std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn places_are_spread_evenly_over_the_area() {
        let sector = seen(2.0, 90.0, 30.0);
        let side = 300;
        let at = |step: u32| (f64::from(step) + 0.5) / f64::from(side);
        let places = (0..side).flat_map(|a| (0..side).map(move |b| [at(a), at(b)]));
        // A quarter of the area is within half the range, and half of it on the left.
        let count = |holds: &dyn Fn(Point) -> bool| {
            places
                .clone()
                .filter(|&two| holds(sector.place(two)))
                .count() as f64
                / f64::from(side * side)
        };
        let facing = way(1.0, 30.0);
        assert!((count(&|way: Point| way.length() < 1.0) - 0.25).abs() < 0.01);
        assert!((count(&|way: Point| facing.cross(way) > 0.0) - 0.5).abs() < 0.01);
    }
}
