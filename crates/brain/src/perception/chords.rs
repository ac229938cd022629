//! The sides of the polygon of free space: chords between the ends of neighbouring rays.

use crate::perception::corners::Protrusion;
use crate::perception::sector::{Sector, direction};
use alloc::vec::Vec;
use base::geometry::{Point, Segment};
use base::trig::{sin_cos, wrapped};
use core::f64::consts::{FRAC_PI_4, TAU};

/// Maximum angle between neighbouring rays: an eighth of a turn, with a margin for rounding.
const NEIGHBOURS_RAD: f64 = FRAC_PI_4 + 1e-9;

/// Two neighbouring rays, or the same ray twice if it has no neighbour on one side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chord {
    pub(super) rays: [usize; 2],
    pub(super) directions: [Point; 2],
    /// A chord is nowhere closer than this fraction of its shorter ray.
    pub(super) nearest_share: f64,
    /// If both rays are longer than this, the whole chord is beside the area swept straight ahead.
    pub(super) beside_m: [f64; 2],
    /// Angle between the front and the closer ray.
    pub(super) off_front_rad: f64,
    pub(super) gap_rad: f64,
    pub(super) protrusion: Protrusion,
}

/// Square of the shortest distance so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub(super) squared_m2: f64,
}

impl Nearest {
    #[inline]
    pub(super) fn new(range_m: f64) -> Self {
        Self {
            squared_m2: range_m * range_m,
        }
    }

    /// Takes a chord into account from which an obstacle may protrude. Returns whether such an obstacle may be in the
    /// sector, or the chord is too far away to matter.
    #[inline]
    pub(super) fn update(
        &mut self,
        chord: &Chord,
        ends_m: [f64; 2],
        protrusion_m: f64,
        sector: &Sector,
    ) -> bool {
        let min_m = chord.nearest_m(ends_m[0].min(ends_m[1]), protrusion_m);
        if min_m * min_m >= self.squared_m2 {
            return true;
        }
        let [from, to] = chord.directions;
        let side = Segment {
            from: from.times(ends_m[0]),
            to: to.times(ends_m[1]),
        };
        let part = sector.part(side, protrusion_m);
        if let Some(part) = part {
            let nearest = part.nearest(Point::default());
            let squared_m2 = if protrusion_m > 0.0 {
                let nearest_m = (nearest.length() - protrusion_m).max(0.0);
                nearest_m * nearest_m
            } else {
                nearest.length_squared()
            };
            self.squared_m2 = self.squared_m2.min(squared_m2);
        }
        part.is_some()
    }

    #[inline]
    pub(super) fn m(self) -> f64 {
        libm::sqrt(self.squared_m2)
    }
}

/// The chords between neighbouring rays, and one for each side of a ray without a neighbour.
pub(super) fn chords(bearings_rad: &[f64]) -> Vec<Chord> {
    let mut rays: Vec<usize> = (0..bearings_rad.len()).collect();
    rays.sort_by(|a, b| bearings_rad[*a].total_cmp(&bearings_rad[*b]));
    let next = rays.iter().cycle().skip(1);
    let pairs = rays.iter().zip(next);
    let chords = pairs.flat_map(|(from, to)| {
        let gap_rad = anticlockwise(bearings_rad[*to] - bearings_rad[*from]);
        if gap_rad <= NEIGHBOURS_RAD {
            [Some([*from, *to]), None]
        } else {
            [Some([*from, *from]), Some([*to, *to])]
        }
    });
    let chords = chords.flatten();
    chords.map(|rays| Chord::new(rays, bearings_rad)).collect()
}

/// The same angle, from 0 to 2 pi.
fn anticlockwise(angle_rad: f64) -> f64 {
    let near = wrapped(angle_rad);
    if near < 0.0 { near + TAU } else { near }
}

impl Chord {
    fn new(rays: [usize; 2], bearings_rad: &[f64]) -> Self {
        let bearings = rays.map(|ray| bearings_rad[ray]);
        let gap_rad = wrapped(bearings[1] - bearings[0]);
        let [from, to] = bearings.map(|bearing| wrapped(bearing).abs());
        Self {
            rays,
            directions: bearings.map(direction),
            beside_m: [f64::INFINITY; 2],
            nearest_share: sin_cos(gap_rad / 2.0).1,
            off_front_rad: from.min(to),
            gap_rad,
            protrusion: Protrusion::default(),
        }
    }

    /// Lower bound of the distance of an obstacle that protrudes from it, by its shorter ray.
    #[inline]
    pub(super) fn nearest_m(&self, shorter_m: f64, protrusion_m: f64) -> f64 {
        (shorter_m * self.nearest_share - protrusion_m).max(0.0)
    }

    /// Infinite where ray lengths do not decide it, or exceed the range of the sensor.
    pub(super) fn beside_m(&self, half_width_m: f64, range_m: f64) -> [f64; 2] {
        let asides = self.directions.map(|direction| direction.y);
        let is_one_side = asides[0] * asides[1] > 0.0;
        asides.map(|aside| {
            let beside_m = self.protrusion.beside_m(aside.abs(), half_width_m);
            if is_one_side && beside_m < range_m {
                beside_m
            } else {
                f64::INFINITY
            }
        })
    }
}
