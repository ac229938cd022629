//! Round pillars.

use super::Point;
use crate::hashed::Hashed;

/// A disc, including its boundary.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub struct Disc {
    /// Its centre.
    pub centre: Point,
    /// Its radius, at least 0.
    pub radius_m: f64,
}

impl Disc {
    /// Whether it contains `point`.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        self.centre.to(point).length_squared() <= self.radius_m * self.radius_m
    }

    /// Distance from `point` to the disc; 0 inside.
    #[must_use]
    pub fn distance_m(&self, point: Point) -> f64 {
        (self.centre.to(point).length() - self.radius_m).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_of_a_disc_belongs_to_it() {
        let disc = Disc {
            centre: [1.0, 1.0].into(),
            radius_m: 5.0,
        };
        assert!(disc.contains([4.0, 5.0].into()));
        assert!(!disc.contains([4.0, 5.000_001].into()));
        assert!((disc.distance_m([7.0, 9.0].into()) - 5.0).abs() < 1e-15);
        assert!(disc.distance_m([2.0, 2.0].into()).abs() < 1e-15);
    }
}
