//! The path of a body in one step: the chords of a circular arc.
//!
//! The corners of the chords lie exactly on the arc, and so does the end of a step; between them
//! the body is on the chord. So it stops where it meets something on a chord, and no bulge of the
//! arc carries it through a wall.

use base::geometry::Point;
use base::trig::{sin_cos, wrapped};

/// Maximum distance of a chord from its arc, in metres.
const MAX_SAGITTA_M: f64 = 2e-4;

/// Maximum number of chords of an arc. Half a turn at 100 m/s for a step of 10 s, on terrain that
/// makes the robot ten times as fast, needs no more.
const MAX_CHORDS: f64 = 8192.0;

/// A heading, with its cosine and sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Orientation {
    /// 0 along x, anticlockwise, from -pi to pi.
    pub(crate) heading_rad: f64,
    /// Unit vector.
    pub(crate) front: Point,
}

impl Orientation {
    #[inline]
    pub(crate) fn new(heading_rad: f64) -> Self {
        let heading_rad = wrapped(heading_rad);
        let (y, x) = sin_cos(heading_rad);
        Self {
            heading_rad,
            front: Point { x, y },
        }
    }

    /// The same as [`Orientation::turned`] where its front is known.
    #[inline]
    pub(crate) fn turned_to(self, by_rad: f64, front: Point) -> Self {
        Self {
            heading_rad: wrapped(self.heading_rad + by_rad),
            front,
        }
    }

    #[inline]
    pub(crate) fn turned(self, by_rad: f64) -> Self {
        if by_rad == 0.0 {
            return self;
        }
        Self::new(self.heading_rad + by_rad)
    }
}

/// The arc of a step, of which a body may complete only a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Path {
    pub(crate) start: Point,
    pub(crate) front: Point,
    /// Forward; negative is reverse.
    pub(crate) length_m: f64,
    /// Anticlockwise.
    pub(crate) turn_rad: f64,
    /// Fraction of the arc after which the body stops, 0 to 1.
    pub(crate) until: f64,
}

impl Path {
    /// The path of a stationary body.
    pub(crate) const fn rest(at: Point) -> Self {
        Self {
            start: at,
            front: Point { x: 1.0, y: 0.0 },
            length_m: 0.0,
            turn_rad: 0.0,
            until: 1.0,
        }
    }

    /// Where the body is after a fraction of the step, 0 to 1.
    #[inline]
    pub(crate) fn at(&self, share: f64) -> Point {
        let share = share.min(self.until);
        if self.turn_rad == 0.0 || share >= 1.0 {
            return self.on_arc(share);
        }
        let chords = f64::from(self.chords());
        let corner = (share * chords).floor();
        let before = self.on_arc(corner / chords);
        let rest = share * chords - corner;
        if rest == 0.0 {
            return before;
        }
        let chord = before.to(self.on_arc((corner + 1.0) / chords));
        before.plus(chord.times(rest))
    }

    #[inline]
    fn on_arc(&self, share: f64) -> Point {
        let length = self.length_m * share;
        if self.turn_rad == 0.0 {
            return self.ahead(length, self.front);
        }
        // The chord of an arc that turns by a: sin(a/2) / (a/2) of its length, turned by a/2.
        let half = self.turn_rad * share / 2.0;
        let (sine, cosine) = sin_cos(half);
        let shorter = if half.abs() < 1e-4 {
            1.0 - half * half / 6.0
        } else {
            sine / half
        };
        let direction = Point {
            x: self.front.x * cosine - self.front.y * sine,
            y: self.front.y * cosine + self.front.x * sine,
        };
        self.ahead(length * shorter, direction)
    }

    fn ahead(&self, length: f64, direction: Point) -> Point {
        Point {
            x: self.start.x + length * direction.x,
            y: self.start.y + length * direction.y,
        }
    }

    /// Number of chords that follow the arc closely: a power of two, so that of two paths the
    /// corners of one are among those of the other.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 1 to MAX_CHORDS"
    )]
    pub(crate) fn chords(&self) -> u32 {
        if self.turn_rad == 0.0 {
            return 1;
        }
        // The sagitta of one chord for the whole is length * turn / 8; it shrinks with the square
        // of their number.
        let sagitta = (self.length_m * self.turn_rad).abs() / 8.0;
        let chords = (sagitta / MAX_SAGITTA_M).sqrt().ceil();
        (chords.clamp(1.0, MAX_CHORDS) as u32).next_power_of_two()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn path(length_m: f64, turn_rad: f64, heading_rad: f64) -> Path {
        Path {
            start: Point { x: 3.0, y: -2.0 },
            front: Orientation::new(heading_rad).front,
            length_m,
            turn_rad,
            until: 1.0,
        }
    }

    proptest! {
        /// With heading h, and a turn by a along the length s: the centre of the circle of radius s
        /// / a is to the left, and the body is opposite to where the heading h + a points.
        #[test]
        fn a_step_ends_on_the_arc_of_the_closed_form(
            length in -50.0_f64..50.0, turn in 0.01_f64..PI, is_left: bool, heading in -PI..PI,
        ) {
            let turn = if is_left { turn } else { -turn };
            let radius = length / turn;
            let end = Point {
                x: 3.0 + radius * (libm::sin(heading + turn) - libm::sin(heading)),
                y: -2.0 - radius * (libm::cos(heading + turn) - libm::cos(heading)),
            };
            let there = path(length, turn, heading).at(1.0);
            prop_assert!(there.to(end).length() < 1e-10, "{there:?} {end:?}");
        }

        #[test]
        fn a_slight_turn_is_as_exact_as_a_strong_one(turn in -1e-3_f64..1e-3) {
            // By the series of the closed form: sin(a) / a and (1 - cos(a)) / a.
            let square = turn * turn;
            let end = Point {
                x: 3.0 + 10.0 * (1.0 - square / 6.0 + square * square / 120.0),
                y: -2.0 + 10.0 * (turn / 2.0 - turn * square / 24.0),
            };
            prop_assert!(path(10.0, turn, 0.0).at(1.0).to(end).length() < 1e-14 * 10.0);
        }

        #[test]
        fn on_the_way_a_body_is_hardly_off_its_arc(
            length in -1000.0_f64..1000.0, turn in -PI..PI, share in 0.0..1.0,
        ) {
            let path = path(length, turn, 0.3);
            let part = Path { length_m: length * share, turn_rad: turn * share, ..path };
            prop_assert!(path.at(share).to(part.at(1.0)).length() <= MAX_SAGITTA_M);
        }

        #[test]
        fn a_body_that_is_stopped_stays_there(
            length in -9.0_f64..9.0, turn in -PI..PI, until in 0.0..1.0, later in 0.0..1.0,
        ) {
            let free = path(length, turn, 0.3);
            let stopped = Path { until, ..free };
            prop_assert_eq!(stopped.at(until + later * (1.0 - until)), free.at(until));
        }
    }

    #[test]
    fn the_longest_arc_of_a_scenario_is_followed_closely_enough() {
        // 100 m/s for 10 s, ten times as fast on some terrain, half a turn.
        let path = path(10_000.0, PI, 0.0);
        let sagitta_m = path.length_m * PI / 8.0 / f64::from(path.chords()).powi(2);
        assert!(sagitta_m <= MAX_SAGITTA_M, "{sagitta_m}");
    }
}
