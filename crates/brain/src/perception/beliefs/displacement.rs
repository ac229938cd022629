//! The displacement of the body since the previous step.

use super::pose::turned;
use crate::io::body::Body;
use crate::perception::dead_reckoning::Odometry;
use crate::perception::sector::direction;
use base::geometry::Point;
use base::hashed::Hashed;

/// Relative odometry error, of the distance and of the turn.
pub(super) const ODOMETRY_ERROR: f64 = 0.02;

/// The same for commanded motion, besides the errors that are [learnt](super::drive_estimate).
const COMMANDED_PATH_ERROR: f64 = 0.003;
const COMMANDED_TURN_ERROR: f64 = 0.05;

/// Tracks and wheels do not turn a body exactly around its centre: error of the position, in metres
/// per radian of a commanded turn.
const PIVOT_ERROR_M: f64 = 0.01;

/// Minimum process noise, also at rest: about a millimetre and some hundredths of a degree per
/// second. It keeps the gain above zero, so that a robot that has been at rest for long still
/// follows its sensors.
const PROCESS_NOISE_M2_S: f64 = 1e-6;
const PROCESS_NOISE_RAD2_S: f64 = 1e-8;

/// The displacement of the body since the previous step, or in a part of a step.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(crate) struct Displacement {
    pub(crate) elapsed_s: f64,
    /// The chord of the path, in the frame of the body at its beginning.
    pub(crate) chord: Point,
    pub(crate) turned_rad: f64,
    /// Length of the path; negative in reverse.
    pub(crate) path_m: f64,
    /// Whether it was commanded, and not measured by the robot.
    pub(crate) is_commanded: bool,
    /// Speed at its beginning and at its end; negative in reverse.
    from_m_s: f64,
    pub(crate) to_m_s: f64,
    /// Process noise: variance of the chord along each axis, and of the turn. It is the sum of those
    /// of the parts.
    pub(crate) variance_m2: f64,
    pub(crate) variance_rad2: f64,
}

impl Displacement {
    /// The displacement to a new speed: constant acceleration first, then motion at that speed, both
    /// at the same turn rate.
    pub(crate) fn new(previous_speed_m_s: f64, to: &Odometry, body: &Body) -> Self {
        let change_m_s = to.speed_m_s - previous_speed_m_s;
        let max_m_s2 = body.max_acceleration_m_s2.max(f64::MIN_POSITIVE);
        let change_s = (change_m_s.abs() / max_m_s2).min(to.elapsed_s);
        if change_s == 0.0 {
            return Self::along(to.speed_m_s * to.elapsed_s, to);
        }
        let rate_rad_s = to.turned_rad / to.elapsed_s;
        let constant_s = to.elapsed_s - change_s;
        let first = accelerating([previous_speed_m_s, to.speed_m_s], change_s, rate_rad_s);
        let second = arc(to.speed_m_s * constant_s, rate_rad_s * constant_s);
        let mean_m_s = f64::midpoint(previous_speed_m_s, to.speed_m_s);
        Self {
            chord: first.plus(turned(second, direction(rate_rad_s * change_s))),
            from_m_s: previous_speed_m_s,
            to_m_s: to.speed_m_s,
            ..Self::along(mean_m_s * change_s + to.speed_m_s * constant_s, to)
        }
    }

    /// The displacement along an arc, at constant speed.
    pub(crate) fn along(path_m: f64, to: &Odometry) -> Self {
        let speed_m_s = path_m / to.elapsed_s.max(f64::MIN_POSITIVE);
        let [path_error, turn_error, pivot_m] = if to.is_commanded {
            [COMMANDED_PATH_ERROR, COMMANDED_TURN_ERROR, PIVOT_ERROR_M]
        } else {
            [ODOMETRY_ERROR, ODOMETRY_ERROR, 0.0]
        };
        let (off_m, off_rad) = (path_error * path_m, turn_error * to.turned_rad);
        let aside_m = pivot_m * to.turned_rad;
        Self {
            elapsed_s: to.elapsed_s,
            chord: arc(path_m, to.turned_rad),
            turned_rad: to.turned_rad,
            path_m,
            is_commanded: to.is_commanded,
            from_m_s: speed_m_s,
            to_m_s: speed_m_s,
            variance_m2: off_m * off_m + aside_m * aside_m + PROCESS_NOISE_M2_S * to.elapsed_s,
            variance_rad2: off_rad * off_rad + PROCESS_NOISE_RAD2_S * to.elapsed_s,
        }
    }

    /// The same, with another length of its path and another turn.
    pub(crate) fn executed(&self, path_m: f64, turned_rad: f64) -> Self {
        // A body that changes its speed drives most of its path at one end of a turn.
        let chord = if self.path_m == 0.0 {
            arc(path_m, turned_rad)
        } else {
            let more = direction((turned_rad - self.turned_rad) / 2.0);
            turned(self.chord.times(path_m / self.path_m), more)
        };
        Self {
            chord,
            turned_rad,
            path_m,
            ..*self
        }
    }

    /// By how much the chord changes with the length of the path.
    pub(crate) fn front(&self) -> Point {
        if self.path_m == 0.0 {
            direction(self.turned_rad / 2.0)
        } else {
            self.chord.times(1.0 / self.path_m)
        }
    }

    /// The mean turn rate.
    pub(crate) fn turn_rate_rad_s(&self) -> f64 {
        self.turned_rad / self.elapsed_s.max(f64::MIN_POSITIVE)
    }

    /// The parts until and from a time after its beginning.
    pub(crate) fn split(&self, after_s: f64, body: &Body) -> [Self; 2] {
        let share = after_s / self.elapsed_s.max(f64::MIN_POSITIVE);
        let max_change_m_s = body.max_acceleration_m_s2 * after_s;
        let change_m_s = self.to_m_s - self.from_m_s;
        let to = Odometry {
            elapsed_s: after_s,
            speed_m_s: self.from_m_s + change_m_s.max(-max_change_m_s).min(max_change_m_s),
            turned_rad: share * self.turned_rad,
            is_commanded: self.is_commanded,
        };
        let until = Self {
            variance_m2: share * self.variance_m2,
            variance_rad2: share * self.variance_rad2,
            ..Self::new(self.from_m_s, &to, body)
        };
        let from = Self {
            elapsed_s: self.elapsed_s - after_s,
            chord: turned(until.chord.to(self.chord), direction(-until.turned_rad)),
            turned_rad: self.turned_rad - until.turned_rad,
            path_m: self.path_m - until.path_m,
            is_commanded: self.is_commanded,
            from_m_s: until.to_m_s,
            to_m_s: self.to_m_s,
            variance_m2: self.variance_m2 - until.variance_m2,
            variance_rad2: self.variance_rad2 - until.variance_rad2,
        };
        [until, from]
    }

    /// This displacement followed by another one.
    pub(crate) fn then(&self, next: &Self) -> Self {
        Self {
            elapsed_s: self.elapsed_s + next.elapsed_s,
            chord: self
                .chord
                .plus(turned(next.chord, direction(self.turned_rad))),
            turned_rad: self.turned_rad + next.turned_rad,
            path_m: self.path_m + next.path_m,
            is_commanded: self.is_commanded || next.is_commanded,
            from_m_s: self.from_m_s,
            to_m_s: next.to_m_s,
            variance_m2: self.variance_m2 + next.variance_m2,
            variance_rad2: self.variance_rad2 + next.variance_rad2,
        }
    }
}

/// The chord of an arc, in the frame at its beginning.
fn arc(path_m: f64, turned_rad: f64) -> Point {
    let half_rad = turned_rad / 2.0;
    let bearing = direction(half_rad);
    let chord_per_arc = if half_rad.abs() < 1e-6 {
        1.0
    } else {
        bearing.y / half_rad
    };
    bearing.times(path_m * chord_per_arc)
}

/// The chord of a path at constant acceleration and turn rate: that of an arc of this length at the
/// mean speed, and an offset to the side of the larger speed.
///
/// With u the time from the middle and h half the turn, the offset is the integral of
/// acceleration u sin(rate u), which is change x time x (sin h - h cos h) / (2 h^2).
fn accelerating([from_m_s, to_m_s]: [f64; 2], elapsed_s: f64, rate_rad_s: f64) -> Point {
    let half_rad = rate_rad_s * elapsed_s / 2.0;
    let bearing = direction(half_rad);
    let share = if half_rad.abs() < 1e-3 {
        half_rad / 6.0
    } else {
        (bearing.y - half_rad * bearing.x) / (2.0 * half_rad * half_rad)
    };
    let offset_m = (to_m_s - from_m_s) * elapsed_s * share;
    let left = Point {
        x: -bearing.y,
        y: bearing.x,
    };
    let path_m = f64::midpoint(from_m_s, to_m_s) * elapsed_s;
    arc(path_m, 2.0 * half_rad).plus(left.times(offset_m))
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
            is_commanded: false,
        }
    }

    #[test]
    fn in_a_gap_a_turning_robot_moves_along_a_circle() {
        for (turned_rad, expected) in [(FRAC_PI_2, [1.0, 1.0]), (TAU, [0.0, 0.0])] {
            let radius_m = 10.0 / turned_rad;
            let moved = Displacement::new(1.0, &odometry(10.0, turned_rad), &rover());
            let end = Point::from(expected).times(radius_m);
            assert!(moved.chord.to(end).length() < 1e-9, "{moved:?}");
        }
    }

    #[test]
    fn in_a_gap_a_robot_accelerates_first() {
        // At 1 m/s2 from rest.
        let moved = Displacement::new(0.0, &odometry(10.0, 0.0), &rover());
        assert!((moved.chord.x - 9.5).abs() < 1e-9, "{moved:?}");
    }

    #[test]
    fn the_parts_of_a_displacement_follow_each_other_to_its_end() {
        for (elapsed_s, turned_rad) in [(0.1, 0.2), (0.1, -0.01), (3.0, 2.0)] {
            let moved = Displacement::new(0.4, &odometry(elapsed_s, turned_rad), &rover());
            let [until, from] = moved.split(0.3 * elapsed_s, &rover());
            let both = until.then(&from);
            assert!(both.chord.to(moved.chord).length() < 1e-12, "{both:?}");
            assert!((both.turned_rad - turned_rad).abs() < 1e-12);
            assert!((both.variance_m2 - moved.variance_m2).abs() < 1e-15);
        }
    }

    #[test]
    fn the_first_part_of_a_displacement_accelerates_as_the_whole() {
        // At 1 m/s2 from rest; at 1 m/s after one second.
        let moved = Displacement::new(0.0, &odometry(10.0, 0.0), &rover());
        for (after_s, path_m) in [(0.5, 0.125), (2.0, 1.5)] {
            let [until, _] = moved.split(after_s, &rover());
            assert!((until.chord.x - path_m).abs() < 1e-9, "{until:?}");
        }
    }

    #[test]
    fn the_first_part_of_an_arc_is_an_arc() {
        let moved = Displacement::new(1.0, &odometry(10.0, TAU), &rover());
        let [until, _] = moved.split(2.5, &rover());
        let radius_m = 10.0 / TAU;
        let quarter = Point::from([radius_m, radius_m]);
        assert!(until.chord.to(quarter).length() < 1e-9, "{until:?}");
    }

    #[test]
    fn the_displacement_is_the_integral_of_the_velocity() {
        let turns_rad = [0.0, 1e-4, -0.3, 2.0, 7.0];
        for (from_m_s, turned_rad) in [-0.5, 0.3, 1.0]
            .into_iter()
            .flat_map(|from_m_s| turns_rad.map(|turned_rad| (from_m_s, turned_rad)))
        {
            let (count, elapsed_s) = (20_000, 2.0);
            let substep_s = elapsed_s / f64::from(count);
            let mut end = Point::default();
            for number in 0..count {
                let now_s = substep_s * (f64::from(number) + 0.5);
                let speed_m_s = (from_m_s + now_s).min(1.0);
                let front = direction(turned_rad * now_s / elapsed_s);
                end = end.plus(front.times(speed_m_s * substep_s));
            }
            let moved = Displacement::new(from_m_s, &odometry(elapsed_s, turned_rad), &rover());
            assert!(moved.chord.to(end).length() < 1e-7, "{moved:?} {end:?}");
        }
    }
}
