//! The displacement of the body since the previous step.

use crate::io::body::Body;
use crate::perception::dead_reckoning::Odometry;
use crate::perception::sector::direction;
use base::geometry::Point;

/// Maximum number of parts of a gap between percepts whose displacements are added.
const MAX_PARTS: f64 = 64.0;

/// The displacement of the body since the previous step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Displacement {
    pub(crate) elapsed_s: f64,
    /// Length of the path.
    pub(crate) path_m: f64,
    /// Length of the chord of the path; negative in reverse.
    pub(crate) chord_m: f64,
    /// Direction of the chord relative to the front in the previous step.
    pub(crate) bearing_rad: f64,
    pub(crate) turned_rad: f64,
    /// Speed at its end; negative in reverse.
    pub(crate) speed_m_s: f64,
}

impl Displacement {
    /// The displacement to a new speed: acceleration first, then motion at that speed, both at the
    /// same turn rate.
    pub(crate) fn new(previous_speed_m_s: f64, to: &Odometry, body: &Body) -> Self {
        if to.elapsed_s > body.period_s {
            Self::in_gap(previous_speed_m_s, to, body)
        } else {
            let path_m = path_m(previous_speed_m_s, to, body, to.elapsed_s);
            Self::along(path_m, to)
        }
    }

    /// Within a period, the path is about as long as its chord, and the speed is the mean speed.
    pub(crate) fn along(path_m: f64, to: &Odometry) -> Self {
        Self {
            elapsed_s: to.elapsed_s,
            path_m,
            chord_m: path_m,
            bearing_rad: to.turned_rad / 2.0,
            turned_rad: to.turned_rad,
            speed_m_s: path_m / to.elapsed_s.max(f64::MIN_POSITIVE),
        }
    }

    /// In a gap between percepts, the path is a chain of arcs.
    fn in_gap(previous_speed_m_s: f64, to: &Odometry, body: &Body) -> Self {
        let count = libm::ceil(to.elapsed_s / body.period_s.max(1e-3)).clamp(2.0, MAX_PARTS);
        let part_s = to.elapsed_s / count;
        let part_rad = to.turned_rad / count;
        let (mut chord, mut before_m, mut part) = (Point::default(), 0.0, 0.0);
        while part < count {
            let after_m = path_m(previous_speed_m_s, to, body, part_s * (part + 1.0));
            let part_m = (after_m - before_m) * chord_per_arc(part_rad);
            chord = chord.plus(direction(part_rad * (part + 0.5)).times(part_m));
            (before_m, part) = (after_m, part + 1.0);
        }
        Self {
            elapsed_s: to.elapsed_s,
            path_m: before_m,
            chord_m: chord.length(),
            bearing_rad: libm::atan2(chord.y, chord.x),
            turned_rad: to.turned_rad,
            speed_m_s: to.speed_m_s,
        }
    }

    /// The chord in the frame of the body in the previous step.
    pub(crate) fn chord(&self) -> Point {
        direction(self.bearing_rad).times(self.chord_m)
    }

    /// The mean turn rate.
    pub(crate) fn turn_rate_rad_s(&self) -> f64 {
        self.turned_rad / self.elapsed_s.max(f64::MIN_POSITIVE)
    }
}

/// Length of the path after a time: acceleration to the new speed first, then motion at that speed.
fn path_m(previous_speed_m_s: f64, to: &Odometry, body: &Body, after_s: f64) -> f64 {
    let change_m_s = to.speed_m_s - previous_speed_m_s;
    let change_s = change_m_s.abs() / body.max_acceleration_m_s2.max(f64::MIN_POSITIVE);
    if after_s < change_s && to.elapsed_s > body.period_s {
        return after_s * (previous_speed_m_s + change_m_s * after_s / change_s / 2.0);
    }
    to.speed_m_s * after_s - change_m_s * change_s.min(after_s) / 2.0
}

/// The length of the chord of an arc, as a fraction of the length of the arc.
fn chord_per_arc(turned_rad: f64) -> f64 {
    let half_rad = turned_rad / 2.0;
    if half_rad.abs() < 1e-6 {
        1.0
    } else {
        direction(half_rad).y / half_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of_walls::rover;
    use core::f64::consts::{FRAC_PI_2, TAU};

    fn odometry(elapsed_s: f64, turned_rad: f64) -> Odometry {
        Odometry {
            elapsed_s,
            speed_m_s: 1.0,
            turned_rad,
        }
    }

    #[test]
    fn in_a_gap_a_turning_robot_moves_along_a_circle() {
        for (turned_rad, expected) in [(FRAC_PI_2, [1.0, 1.0]), (TAU, [0.0, 0.0])] {
            let radius_m = 10.0 / turned_rad;
            let moved = Displacement::new(1.0, &odometry(10.0, turned_rad), &rover());
            let end = Point::from(expected).times(radius_m);
            assert!(moved.chord().to(end).length() < 1e-9, "{moved:?}");
            assert!((moved.path_m - 10.0).abs() < 1e-9);
        }
    }

    #[test]
    fn in_a_gap_a_robot_accelerates_first() {
        // At 1 m/s2 from rest.
        let moved = Displacement::new(0.0, &odometry(10.0, 0.0), &rover());
        assert!((moved.chord_m - 9.5).abs() < 1e-9, "{moved:?}");
    }
}
