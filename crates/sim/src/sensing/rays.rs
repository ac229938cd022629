//! Exact rays: how far a ring's rays go before they meet something.
//!
//! This is where a run's time goes. What is near has been gathered ([`Near`]), relative to the
//! robot; here each vector of rays is held against it, piece by piece. Whether a piece meets any ray
//! of a vector is as good as random, and a mispredicted branch costs as much as four of these tests.
//! So first all pieces that do are noted, without a branch, in some four cycles a disc and seven a
//! wall and vector; then a root or a quotient is taken for each of those, in some twenty cycles.
//!
//! The result is a minimum over pieces, so their order changes nothing, and it is made of additions,
//! multiplications, quotients and roots only, without fused ones: so all instruction sets give the
//! same bits.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use crate::world::still::Wall;
use base::geometry::{Disc, Point};
use pulp::Simd;
use std::array::from_fn;

/// Rays are handled in groups of so many; the widest vector there is holds that many.
pub(crate) const GROUP: usize = base::philox::LANES;

/// How far a ray may pass beside a wall's end and still meet it, in metres: no ray slips through
/// where two walls meet.
const CRACK_M: f64 = 1e-9;

/// Where a product stands for a quotient it may be off by rounding, but by less than this factor.
const HAIR: f64 = 1.0 + 1e-12;

/// What rays can meet, relative to a robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    discs: Few<NearDisc>,
    walls: Few<NearWall>,
    /// Directions of the rays of each group in the world, along x and y.
    rays: Vec<[[f64; GROUP]; 2]>,
    /// Which vector of rays meets which piece.
    hits: Vec<[u32; 2]>,
}

/// The first so many of a list that never shrinks.
#[derive(Debug, Clone, Default)]
struct Few<T> {
    all: Vec<T>,
    count: usize,
}

#[derive(Debug, Clone, Copy, Default)]
struct NearDisc {
    centre: Point,
    /// Square of the distance to the centre, less the square of the radius; 0 for one in the disc.
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
    /// Takes those that `near` says are.
    ///
    /// That is as good as random: each is written down in any case, and then written over if it was
    /// not, which is faster than a branch that is mispredicted.
    #[inline]
    fn take<U>(&mut self, from: impl Iterator<Item = U>, near: impl Fn(U) -> (T, bool)) {
        let most = from.size_hint().1.unwrap_or(0);
        if self.all.len() < most {
            self.all.resize(most, T::default());
        }
        let mut count = 0;
        from.for_each(|each| {
            let (value, is_near) = near(each);
            if let Some(place) = self.all.get_mut(count) {
                *place = value;
            }
            count += usize::from(is_near);
        });
        self.count = count;
    }

    #[inline]
    fn of(&self) -> &[T] {
        &self.all[..self.count]
    }
}

impl Near {
    /// Takes what of these a ray of `range_m` from `at` can meet, and maybe some more.
    #[inline]
    pub(crate) fn gather<'a>(
        &mut self,
        at: Point,
        range_m: f64,
        discs: impl Iterator<Item = &'a Disc>,
        walls: impl Iterator<Item = &'a Wall>,
    ) {
        self.discs.take(discs, |disc| {
            let centre = at.to(disc.centre);
            let square = centre.length_squared();
            let power = (square - disc.radius_m * disc.radius_m).max(0.0);
            let reach = range_m + disc.radius_m;
            (NearDisc { centre, power }, square < reach * reach)
        });
        self.walls.take(walls, |wall| {
            let (start, end) = (at.to(wall.start), at.to(wall.end()));
            let area = start.cross(end);
            #[expect(
                clippy::needless_bitwise_bool,
                reason = "a branch would be mispredicted"
            )]
            let is_near = (area > 0.0) & (area < range_m * wall.length);
            (NearWall { start, end, area }, is_near)
        });
    }
}

/// Directions of a ring's rays, from the robot's front.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rays {
    /// The last direction repeated until the groups are full.
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
    /// `front` is the direction of the robot's front, of length 1.
    #[inline(always)]
    pub(crate) fn cast<S: Simd>(
        &self,
        simd: S,
        (front, range_m): (Point, f64),
        near: &mut Near,
        to: &mut [[f64; GROUP]],
    ) {
        near.rays.clear();
        let directions = self.cosines.iter().zip(&self.sines);
        near.rays.extend(directions.map(|(cosines, sines)| {
            [
                from_fn(|lane| cosines[lane] * front.x - sines[lane] * front.y),
                from_fn(|lane| cosines[lane] * front.y + sines[lane] * front.x),
            ]
        }));
        to.fill([range_m; GROUP]);
        let Near {
            discs,
            walls,
            rays,
            hits,
        } = near;
        meet(simd, rays, discs.of(), hits, to);
        meet(simd, rays, walls.of(), hits, to);
    }
}

/// Something that rays can meet.
trait Piece {
    /// Which rays meet it, if no farther than `reach`, and what their distances are made of.
    fn meets<S: Simd>(
        &self,
        simd: S,
        rays: [S::f64s; 2],
        reach: S::f64s,
    ) -> (S::m64s, [S::f64s; 2]);

    /// Their distances.
    fn distance<S: Simd>(simd: S, parts: [S::f64s; 2]) -> S::f64s;
}

/// Shortens rays to where they meet the pieces.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rays and robots have 32-bit numbers"
)]
fn meet<S: Simd, P: Piece>(
    simd: S,
    rays: &[[[f64; GROUP]; 2]],
    pieces: &[P],
    hits: &mut Vec<[u32; 2]>,
    to: &mut [[f64; GROUP]],
) {
    let to = S::as_mut_simd_f64s(to.as_flattened_mut()).0;
    let rays = S::as_simd_f64s(rays.as_flattened().as_flattened()).0;
    let in_group = GROUP / S::F64_LANES;
    // The vectors along x of a group come before those along y.
    let direction = |vector: usize| {
        let x = vector / in_group * 2 * in_group + vector % in_group;
        [rays[x], rays[x + in_group]]
    };
    if hits.len() < to.len() * pieces.len() {
        hits.resize(to.len() * pieces.len(), [0; 2]);
    }
    let mut found = 0;
    for (vector, nearest) in to.iter().enumerate() {
        let (rays, reach) = (
            direction(vector),
            simd.mul_f64s(*nearest, simd.splat_f64s(HAIR)),
        );
        for (number, piece) in pieces.iter().enumerate() {
            let (meets, _) = piece.meets(simd, rays, reach);
            hits[found] = [vector as u32, number as u32];
            found += usize::from(simd.first_true_m64s(meets) < S::F64_LANES);
        }
    }
    for [vector, number] in &hits[..found] {
        let nearest = &mut to[*vector as usize];
        let reach = simd.mul_f64s(*nearest, simd.splat_f64s(HAIR));
        let piece = &pieces[*number as usize];
        let (meets, parts) = piece.meets(simd, direction(*vector as usize), reach);
        let distance = simd.select_f64s(meets, P::distance(simd, parts), reach);
        *nearest = simd.min_f64s(distance, *nearest);
    }
}

/// A ray of direction u meets the disc about c at the lesser root of t^2 - 2 (u.c) t + power.
impl Piece for NearDisc {
    #[inline(always)]
    fn meets<S: Simd>(&self, simd: S, [x, y]: [S::f64s; 2], _: S::f64s) -> (S::m64s, [S::f64s; 2]) {
        let centre_x = simd.splat_f64s(self.centre.x);
        let centre_y = simd.splat_f64s(self.centre.y);
        let ahead = simd.add_f64s(simd.mul_f64s(x, centre_x), simd.mul_f64s(y, centre_y));
        let square = simd.mul_f64s(ahead, ahead);
        let root = simd.sub_f64s(square, simd.splat_f64s(self.power));
        let zero = simd.splat_f64s(0.0);
        let meets = simd.and_m64s(
            simd.greater_than_f64s(ahead, zero),
            simd.greater_than_or_equal_f64s(root, zero),
        );
        (meets, [ahead, root])
    }

    #[inline(always)]
    fn distance<S: Simd>(simd: S, [ahead, root]: [S::f64s; 2]) -> S::f64s {
        simd.sub_f64s(ahead, simd.sqrt_f64s(root))
    }
}

/// A ray passes between the wall's ends if it leaves the start to its right and the end to its left.
impl Piece for NearWall {
    #[inline(always)]
    fn meets<S: Simd>(
        &self,
        simd: S,
        [x, y]: [S::f64s; 2],
        reach: S::f64s,
    ) -> (S::m64s, [S::f64s; 2]) {
        let start = simd.sub_f64s(
            simd.mul_f64s(x, simd.splat_f64s(self.start.y)),
            simd.mul_f64s(y, simd.splat_f64s(self.start.x)),
        );
        let end = simd.sub_f64s(
            simd.mul_f64s(x, simd.splat_f64s(self.end.y)),
            simd.mul_f64s(y, simd.splat_f64s(self.end.x)),
        );
        let is_between = simd.and_m64s(
            simd.less_than_or_equal_f64s(start, simd.splat_f64s(CRACK_M)),
            simd.greater_than_or_equal_f64s(end, simd.splat_f64s(-CRACK_M)),
        );
        let span = simd.sub_f64s(end, start);
        let area = simd.splat_f64s(self.area);
        let is_in_reach = simd.less_than_f64s(area, simd.mul_f64s(span, reach));
        (simd.and_m64s(is_between, is_in_reach), [area, span])
    }

    #[inline(always)]
    fn distance<S: Simd>(simd: S, [area, span]: [S::f64s; 2]) -> S::f64s {
        simd.div_f64s(area, span)
    }
}

#[cfg(test)]
mod tests;
