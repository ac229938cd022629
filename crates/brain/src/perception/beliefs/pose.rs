//! The estimated pose of the robot, and its transforms.

use crate::perception::sector::direction;
use base::geometry::Point;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An estimated position and heading, each with its standard deviation.
///
/// Both are predicted by odometry and corrected by each new reading in proportion to the variances (Kalman,
/// *A new approach to linear filtering and prediction problems*, 1960, in one dimension): gain = own
/// variance / (own variance + variance of the sensor). A reading that differs by more than five standard
/// deviations is ignored, unless three in a row agree: then the estimate is reset to the last one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
pub struct Pose {
    /// Position in the world.
    pub at: Point,
    /// Heading: 0 along x, anticlockwise, from -pi to pi.
    pub heading_rad: f64,
    /// Standard deviation of the position, along each axis.
    pub deviation_m: f64,
    /// Standard deviation of the heading.
    pub deviation_rad: f64,
    /// Age of the last position reading.
    pub age_s: f64,
}

impl Pose {
    /// Tolerance of visibility tests: two standard deviations, which the errors of the robot's
    /// position and of obstacles on its map exceed in one of twenty cases.
    pub(crate) fn blur_m(&self) -> f64 {
        2.0 * self.deviation_m
    }

    /// Transforms a position from the robot's frame to the world.
    #[inline]
    pub(crate) fn in_world(&self, at: Point) -> Point {
        self.at.plus(turned(at, direction(self.heading_rad)))
    }

    /// Transforms a position from the world to the robot's frame.
    #[inline]
    pub(crate) fn in_own_frame(&self, at: Point) -> Point {
        let front = direction(self.heading_rad);
        let back = Point {
            x: front.x,
            y: -front.y,
        };
        turned(self.at.to(at), back)
    }
}

/// `vector` rotated by the angle from the x axis to `front`, which has length 1.
#[inline]
pub(crate) fn turned(vector: Point, front: Point) -> Point {
    Point {
        x: vector.x * front.x - vector.y * front.y,
        y: vector.x * front.y + vector.y * front.x,
    }
}
