//! Exact ray casting: the distance at which the rays of a ring meet something.
//!
//! Most of the time of a run is spent here. Nearby geometry has been gathered ([`Near`]), relative
//! to the robot; here each vector of rays is tested against it, piece by piece. Whether a piece
//! meets any ray of a vector is as good as random, so there is no branch; and a root or a quotient
//! takes as long as three of these tests, so the first piece is determined without one, and one is
//! computed for it.
//!
//! The result is a minimum over pieces, so their order changes nothing but the last bit where two
//! are equally near, and it uses only additions, multiplications, quotients and roots, none of them
//! fused: all instruction sets give the same bits.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use crate::world::static_geometry::Wall;
use base::geometry::{Disc, Point};
use pulp::Simd;
use std::array::from_fn;

/// Rays are processed in groups of this size, that of the widest vector.
pub(crate) const GROUP: usize = base::philox::LANES;

/// A ray that passes the end of a wall at up to this distance still meets it, in metres: no ray
/// slips through where two walls meet.
const CRACK_M: f64 = 1e-9;

/// What rays can meet, relative to a robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    at: Point,
    range_m: f64,
    /// Discs that overlap no other: of two, a ray first meets the one whose centre is less far
    /// along it.
    apart: Few<NearDisc>,
    /// Discs that may overlap each other.
    overlapping: Few<NearDisc>,
    walls: Few<NearWall>,
}

/// The first entries of a list that never shrinks.
#[derive(Debug, Clone, Default)]
struct Few<T> {
    all: Vec<T>,
    count: usize,
}

#[derive(Debug, Clone, Copy, Default)]
struct NearDisc {
    centre: Point,
    /// Squared distance to the centre minus the squared radius; 0 for a robot inside the disc.
    power: f64,
}

/// A wall with the robot on its free side, to the left of the way from its start to its end.
#[derive(Debug, Clone, Copy, Default)]
struct NearWall {
    start: Point,
    end: Point,
    /// Twice the area between it and the robot.
    area: f64,
}

impl<T: Copy + Default> Few<T> {
    /// Keeps the pieces for which `near` is true.
    ///
    /// That is as good as random: each piece is written in any case, and overwritten if it is not
    /// near, which is faster than a mispredicted branch.
    #[inline]
    fn take<U>(&mut self, from: impl ExactSizeIterator<Item = U>, near: impl Fn(U) -> (T, bool)) {
        let most = self.count + from.len();
        if self.all.len() < most {
            self.all.resize(most, T::default());
        }
        let mut count = self.count;
        for each in from {
            let (value, is_near) = near(each);
            if let Some(place) = self.all.get_mut(count) {
                *place = value;
            }
            count += usize::from(is_near);
        }
        self.count = count;
    }

    #[inline]
    fn of(&self) -> &[T] {
        &self.all[..self.count]
    }
}

impl Near {
    /// Nothing, as seen from a place by rays of `range_m`.
    #[inline]
    pub(crate) fn begin(&mut self, at: Point, range_m: f64) {
        (self.at, self.range_m) = (at, range_m);
        (self.apart.count, self.overlapping.count, self.walls.count) = (0, 0, 0);
    }

    /// Gathers those of these discs that a ray can meet, and possibly some more; they overlap no
    /// others.
    #[inline]
    pub(crate) fn take_apart(&mut self, discs: impl ExactSizeIterator<Item = Disc>) {
        let (at, range_m) = (self.at, self.range_m);
        self.apart
            .take(discs, |disc| NearDisc::of(&disc, at, range_m));
    }

    /// The same for discs that may overlap each other.
    #[inline]
    pub(crate) fn take_overlapping(&mut self, discs: impl ExactSizeIterator<Item = Disc>) {
        let (at, range_m) = (self.at, self.range_m);
        self.overlapping
            .take(discs, |disc| NearDisc::of(&disc, at, range_m));
    }

    /// The same for walls.
    #[inline]
    pub(crate) fn take_walls<'a>(&mut self, walls: impl ExactSizeIterator<Item = &'a Wall>) {
        let (at, range_m) = (self.at, self.range_m);
        self.walls
            .take(walls, |wall| NearWall::of(wall, at, range_m));
    }
}

impl NearDisc {
    #[inline]
    fn of(disc: &Disc, at: Point, range_m: f64) -> (Self, bool) {
        let centre = at.to(disc.centre);
        let square = centre.length_squared();
        let power = (square - disc.radius_m * disc.radius_m).max(0.0);
        let reach = range_m + disc.radius_m;
        (Self { centre, power }, square < reach * reach)
    }
}

impl NearWall {
    #[inline]
    fn of(wall: &Wall, at: Point, range_m: f64) -> (Self, bool) {
        let (start, end) = (at.to(wall.start), at.to(wall.end()));
        let area = start.cross(end);
        #[expect(
            clippy::needless_bitwise_bool,
            reason = "a branch would be mispredicted"
        )]
        let is_near = (area > 0.0) & (area < range_m * wall.length);
        (Self { start, end, area }, is_near)
    }
}

/// Directions of a ring's rays, relative to the robot's front.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rays {
    /// The last direction is repeated to fill the groups.
    cosines: Vec<[f64; GROUP]>,
    sines: Vec<[f64; GROUP]>,
}

impl Rays {
    pub(crate) fn new(bearings_rad: &[f64]) -> Self {
        let direction = |group: usize, lane: usize| {
            let ray = (group * GROUP + lane).min(bearings_rad.len() - 1);
            base::trig::sin_cos(bearings_rad[ray])
        };
        let groups = 0..bearings_rad.len().div_ceil(GROUP);
        let of = |part: fn((f64, f64)) -> f64| {
            let group = |group| from_fn(|lane| part(direction(group, lane)));
            groups.clone().map(group).collect()
        };
        Self {
            cosines: of(|(_, cosine)| cosine),
            sines: of(|(sine, _)| sine),
        }
    }

    /// Groups of rays.
    pub(crate) fn groups(&self) -> usize {
        self.cosines.len()
    }

    /// The distance at which each ray meets what is near, `range_m` where it meets nothing.
    ///
    /// `front` is the unit vector of the robot's heading.
    #[inline(always)]
    pub(crate) fn cast<S: Simd>(
        &self,
        simd: S,
        (front, range_m): (Point, f64),
        near: &Near,
        to: &mut [[f64; GROUP]],
    ) {
        let cosines = S::as_simd_f64s(self.cosines.as_flattened()).0;
        let sines = S::as_simd_f64s(self.sines.as_flattened()).0;
        let to = S::as_mut_simd_f64s(to.as_flattened_mut()).0;
        let (front_x, front_y) = (simd.splat_f64s(front.x), simd.splat_f64s(front.y));
        for ((cosine, sine), to) in cosines.iter().zip(sines).zip(to) {
            let x = simd.sub_f64s(
                simd.mul_f64s(*cosine, front_x),
                simd.mul_f64s(*sine, front_y),
            );
            let y = simd.add_f64s(
                simd.mul_f64s(*cosine, front_y),
                simd.mul_f64s(*sine, front_x),
            );
            let rays = Beam { simd, x, y };
            let to_wall = rays.to_walls(near.walls.of(), range_m);
            let to_disc = rays.to_discs_apart(near.apart.of());
            let to_any_disc = rays.to_discs(near.overlapping.of(), to_disc);
            *to = simd.min_f64s(to_wall, to_any_disc);
        }
    }
}

/// A vector of rays: their directions.
#[derive(Clone, Copy)]
struct Beam<S: Simd> {
    simd: S,
    x: S::f64s,
    y: S::f64s,
}

impl<S: Simd> Beam<S> {
    /// The distance to the nearest wall, at most `range_m`.
    ///
    /// A ray passes between the ends of a wall if it has the start on its right and the end on its
    /// left. The distance is the wall's area divided by its span across the ray; of two walls, the
    /// one with the smaller quotient is nearer, which products decide.
    #[inline(always)]
    fn to_walls(self, walls: &[NearWall], range_m: f64) -> S::f64s {
        let Self { simd, .. } = self;
        let [before, behind] = [CRACK_M, -CRACK_M].map(|crack_m| simd.splat_f64s(crack_m));
        let mut nearest = [simd.splat_f64s(range_m), simd.splat_f64s(1.0)];
        for wall in walls {
            let [start, end] = [wall.start, wall.end].map(|place| self.across(place));
            let [area, span] = [simd.splat_f64s(wall.area), simd.sub_f64s(end, start)];
            let is_between = simd.and_m64s(
                simd.less_than_or_equal_f64s(start, before),
                simd.greater_than_or_equal_f64s(end, behind),
            );
            let is_nearer = simd.less_than_f64s(
                simd.mul_f64s(area, nearest[1]),
                simd.mul_f64s(nearest[0], span),
            );
            let is_met = simd.and_m64s(is_between, is_nearer);
            nearest = [
                simd.select_f64s(is_met, area, nearest[0]),
                simd.select_f64s(is_met, span, nearest[1]),
            ];
        }
        simd.div_f64s(nearest[0], nearest[1])
    }

    /// The distance to the first of some discs that do not overlap, infinite if there is none.
    ///
    /// The first is the one whose centre is ahead and least far. Interpreted as integers, all
    /// distances behind are greater than those ahead, so one comparison decides both.
    #[inline(always)]
    fn to_discs_apart(self, discs: &[NearDisc]) -> S::f64s {
        let Self { simd, .. } = self;
        let [never, zero] = [f64::INFINITY, 0.0].map(|number| simd.splat_f64s(number));
        let mut nearest = [never, zero];
        for disc in discs {
            let [ahead, square] = self.chord(disc);
            let [this, first] = [ahead, nearest[0]].map(|ahead| simd.transmute_u64s_f64s(ahead));
            let is_met = simd.and_m64s(
                simd.less_than_u64s(this, first),
                simd.greater_than_or_equal_f64s(square, zero),
            );
            nearest = [
                simd.select_f64s(is_met, ahead, nearest[0]),
                simd.select_f64s(is_met, square, nearest[1]),
            ];
        }
        simd.sub_f64s(nearest[0], simd.sqrt_f64s(nearest[1]))
    }

    /// The distance to the first of any discs, at most `nearest`.
    #[inline(always)]
    fn to_discs(self, discs: &[NearDisc], mut nearest: S::f64s) -> S::f64s {
        let Self { simd, .. } = self;
        let zero = simd.splat_f64s(0.0);
        for disc in discs {
            let [ahead, square] = self.chord(disc);
            let is_met = simd.and_m64s(
                simd.greater_than_f64s(ahead, zero),
                simd.greater_than_or_equal_f64s(square, zero),
            );
            let distance = simd.sub_f64s(ahead, simd.sqrt_f64s(square));
            let distance = simd.select_f64s(is_met, distance, nearest);
            nearest = simd.min_f64s(distance, nearest);
        }
        nearest
    }

    /// The distance of a disc's centre along the rays, and the squared half chord that they cut out
    /// of it; less than 0 if they miss it.
    ///
    /// A ray of direction u meets the disc about c at the smaller root of t^2 - 2 (u.c) t + power.
    #[inline(always)]
    fn chord(self, disc: &NearDisc) -> [S::f64s; 2] {
        let Self { simd, x, y } = self;
        let ahead = simd.add_f64s(
            simd.mul_f64s(x, simd.splat_f64s(disc.centre.x)),
            simd.mul_f64s(y, simd.splat_f64s(disc.centre.y)),
        );
        let square = simd.sub_f64s(simd.mul_f64s(ahead, ahead), simd.splat_f64s(disc.power));
        [ahead, square]
    }

    /// The distance of a place to the left of each ray.
    #[inline(always)]
    fn across(self, place: Point) -> S::f64s {
        let Self { simd, x, y } = self;
        simd.sub_f64s(
            simd.mul_f64s(x, simd.splat_f64s(place.y)),
            simd.mul_f64s(y, simd.splat_f64s(place.x)),
        )
    }
}

#[cfg(test)]
mod tests;
