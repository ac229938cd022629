//! A field of view.

use base::geometry::Point;
use base::trig::sin_cos;

/// What is within some distance and angle of a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sector {
    pub(crate) range_m: f64,
    pub(crate) width_rad: f64,
    facing_rad: f64,
    /// Of length 1, from the robot's front.
    facing: Point,
    /// Cosine of half the width.
    edge: f64,
}

impl Sector {
    pub(crate) fn new(range_m: f64, width_deg: f64, facing_deg: f64) -> Self {
        let (width_rad, facing_rad) = (width_deg.to_radians(), facing_deg.to_radians());
        let (y, x) = sin_cos(facing_rad);
        Self {
            range_m,
            width_rad,
            facing_rad,
            facing: Point { x, y },
            edge: sin_cos(width_rad / 2.0).1,
        }
    }

    /// Whether it holds what is at `way` from the robot's front.
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

    /// A place in it, uniformly, from two numbers from 0 to 1.
    pub(crate) fn place(&self, [one, other]: [f64; 2]) -> Point {
        let range_m = self.range_m * one.sqrt();
        let (y, x) = sin_cos(self.facing_rad + (other - 0.5) * self.width_rad);
        Point { x, y }.times(range_m)
    }
}
