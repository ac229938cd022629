//! By how much an obstacle may protrude between two neighbouring rays.
//!
//! Two rays at an angle of `g` end on an obstacle, the nearer one at range `r`. A corner of 90 degrees
//! between them lies on the circle around their chord (Thales), whose part between the rays is no
//! farther from the chord than the perpendicular from the nearer end to the other ray is long:
//! `r sin g`. The corner of an obstacle that only the nearer ray hits lies within the same distance of
//! that ray where it ends. So no obstacle with such corners that is wider than `r sin g` protrudes by
//! more. A thinner one, such as the end of a thin wall, may be between the rays unseen.
//!
//! The clearance of the robot covers a part of it; for widely spaced rays, that at a contact: the
//! sensor could otherwise not prove that any door is wide enough. For still wider ones walls count as
//! flat: in an aisle, the robot would hardly move.

use base::trig::sin_cos;
use core::f64::consts::FRAC_PI_2;

/// Sine of the largest angle between two rays at which corners between them count: that of 32 rays
/// around the robot.
pub const MAX_CORNER_SINE: f64 = 0.2;

/// The width of the path of a body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Width {
    /// Half the width of the body, with its clearance.
    pub(crate) half_width_m: f64,
    pub(crate) clearance_m: f64,
}

/// The protrusion between two rays by the range of the nearer one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Protrusion {
    /// Sine of the angle between the rays.
    sine: f64,
    /// The protrusion that needs no further room.
    covered_m: f64,
}

impl Protrusion {
    /// Between two rays at an angle, for a body of this width.
    pub(super) fn new(gap_rad: f64, width: Width) -> Self {
        let sine = sin_cos(gap_rad.abs().min(FRAC_PI_2)).0;
        Self {
            sine: if sine <= MAX_CORNER_SINE { sine } else { 0.0 },
            covered_m: width.clearance_m.max(width.half_width_m * sine),
        }
    }

    /// Whether walls count as flat.
    pub(super) fn is_flat(self) -> bool {
        self.sine == 0.0
    }

    /// The greater of two.
    pub(super) fn or(self, other: Self) -> Self {
        if other.sine > self.sine { other } else { self }
    }

    /// The protrusion that needs room, if the nearer ray ends at `range_m`.
    #[inline]
    pub(super) fn at_m(self, range_m: f64) -> f64 {
        (self.sine * range_m - self.covered_m).max(0.0)
    }

    /// The range of both rays from which on an obstacle at their ends is farther than `half_width_m`
    /// from a line; `aside` is the sine of the angle between that line and a ray.
    pub(super) fn beside_m(self, aside: f64, half_width_m: f64) -> f64 {
        let flat_m = half_width_m / aside;
        let rest = aside - self.sine;
        if rest > 0.0 {
            flat_m.max((half_width_m - self.covered_m) / rest)
        } else {
            f64::INFINITY
        }
    }
}
