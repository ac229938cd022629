//! Where a body goes in one step: along the chords of a circular arc.
//!
//! The corners of the chords are on the arc, exactly, and so is where a step ends; in between a body
//! is on the chord. So where it meets something on a chord it also comes to stand there, and no
//! bulge of the arc carries it through a wall.

use base::geometry::Point;
use base::trig::{sin_cos, wrapped};

/// How far a chord may be from its arc, in metres.
const MAX_SAGITTA_M: f64 = 2e-4;

/// Chords that an arc is cut into at most. Half a turn at 100 m/s for a step of 10 s, over ground
/// that makes ten times as fast, needs no more.
const MAX_CHORDS: f64 = 8192.0;

/// A direction, with its cosine and sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Course {
    /// 0 along x, anticlockwise, from -pi to pi.
    pub(crate) heading_rad: f64,
    /// Of length 1.
    pub(crate) front: Point,
}

impl Course {
    #[inline]
    pub(crate) fn new(heading_rad: f64) -> Self {
        let heading_rad = wrapped(heading_rad);
        let (y, x) = sin_cos(heading_rad);
        Self {
            heading_rad,
            front: Point { x, y },
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

/// The arc of a step, of which a body may go a part only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Path {
    pub(crate) start: Point,
    pub(crate) front: Point,
    /// Ahead; negative is backwards.
    pub(crate) length_m: f64,
    /// Anticlockwise.
    pub(crate) turn_rad: f64,
    /// Share of the arc after which the body stands, 0 to 1.
    pub(crate) until: f64,
}

impl Path {
    /// That of a body that stands.
    pub(crate) const fn rest(at: Point) -> Self {
        Self {
            start: at,
            front: Point { x: 1.0, y: 0.0 },
            length_m: 0.0,
            turn_rad: 0.0,
            until: 1.0,
        }
    }

    /// Where the body is after a share of the step, 0 to 1.
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

    /// Chords that follow the arc closely: a power of two, so that of two paths the corners of one
    /// are among those of the other.
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
        // The sagitta of one chord for the whole is length * turn / 8; it shrinks with their square.
        let sagitta = (self.length_m * self.turn_rad).abs() / 8.0;
        let chords = (sagitta / MAX_SAGITTA_M).sqrt().ceil();
        (chords.clamp(1.0, MAX_CHORDS) as u32).next_power_of_two()
    }
}
