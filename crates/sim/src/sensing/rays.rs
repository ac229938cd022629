//! Exact rays: how far a ring's rays go before they meet something.
//!
//! This is where a run's time goes. What is near has been gathered ([`Near`]), relative to the
//! robot; here each vector of rays is held against it, piece by piece. Most pieces miss all rays of
//! a vector, which a comparison tells before a root or a quotient is taken: some three cycles a
//! piece and vector. The result is a minimum over pieces, so their order changes nothing, and it is
//! made of additions, multiplications, quotients and roots only, without fused ones: so all
//! instruction sets give the same bits.

use crate::world::still::Wall;
use base::geometry::{Disc, Point};
use pulp::{Arch, Simd, WithSimd};

/// Rays are handled in groups of so many; the widest vector there is holds that many.
const GROUP: usize = 8;

/// How far a ray may pass beside a wall's end and still meet it, in metres: no ray slips through
/// where two walls meet.
const CRACK_M: f64 = 1e-9;

/// What rays can meet, relative to a robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    /// Of these, the first so many.
    discs: Vec<NearDisc>,
    disc_count: usize,
    walls: Vec<NearWall>,
    wall_count: usize,
}

#[derive(Debug, Clone, Copy, Default)]
struct NearDisc {
    centre: Point,
    /// Square of the distance to the centre, less the square of the radius; 0 for one in the disc.
    power: f64,
}

#[derive(Debug, Clone, Copy, Default)]
struct NearWall {
    /// Direction, with what is free to its left.
    along: Point,
    /// The robot's distance from its line; above 0.
    height: f64,
    /// How far along the line the robot is, from the wall's beginning.
    foot: f64,
    length: f64,
}

impl Near {
    /// Takes what of these a ray of `range_m` from `at` can meet.
    ///
    /// Whether a thing is near is as good as random: it is written down in any case, and then
    /// written over if it was not, which is faster than a branch that is mispredicted.
    #[inline]
    pub(crate) fn gather<'a>(
        &mut self,
        at: Point,
        range_m: f64,
        discs: impl Iterator<Item = &'a Disc>,
        walls: impl Iterator<Item = &'a Wall>,
    ) {
        let mut found = 0;
        for disc in discs {
            let way = at.to(disc.centre);
            let square = way.length_squared();
            let reach = range_m + disc.radius_m;
            if found == self.discs.len() {
                self.discs.push(NearDisc::default());
            }
            self.discs[found] = NearDisc {
                centre: way,
                power: (square - disc.radius_m * disc.radius_m).max(0.0),
            };
            found += usize::from(square < reach * reach);
        }
        self.disc_count = found;
        let mut found = 0;
        for wall in walls {
            let way = at.to(wall.start);
            let height = way.cross(wall.along);
            let foot = -way.dot(wall.along);
            if found == self.walls.len() {
                self.walls.push(NearWall::default());
            }
            self.walls[found] = NearWall {
                along: wall.along,
                height,
                foot,
                length: wall.length,
            };
            let is_near = (height > 0.0) & (height < range_m);
            let is_beside = (foot > -range_m) & (foot < wall.length + range_m);
            found += usize::from(is_near & is_beside);
        }
        self.wall_count = found;
    }
}

/// Directions of a ring's rays, from the robot's front.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rays {
    /// The last direction repeated until the groups are full.
    cosines: Vec<[f64; GROUP]>,
    sines: Vec<[f64; GROUP]>,
    count: usize,
}

impl Rays {
    pub(crate) fn new(bearings_rad: &[f64]) -> Self {
        let direction = |group: usize, lane: usize| {
            let ray = (group * GROUP + lane).min(bearings_rad.len() - 1);
            base::trig::sin_cos(bearings_rad[ray])
        };
        let groups = 0..bearings_rad.len().div_ceil(GROUP);
        let of = |part: fn((f64, f64)) -> f64| {
            let group = |group| std::array::from_fn(|lane| part(direction(group, lane)));
            groups.clone().map(group).collect()
        };
        Self {
            cosines: of(|(_, cosine)| cosine),
            sines: of(|(sine, _)| sine),
            count: bearings_rad.len(),
        }
    }

    /// The distance at which each ray meets what is near, `range_m` where it meets nothing.
    ///
    /// `front` is the direction of the robot's front, of length 1.
    #[inline]
    pub(crate) fn cast(&self, front: Point, near: &Near, range_m: f64, to: &mut Vec<f64>) {
        to.clear();
        to.resize(self.cosines.len() * GROUP, range_m);
        Arch::new().dispatch(Cast {
            rays: self,
            front,
            near,
            to,
        });
        to.truncate(self.count);
    }
}

struct Cast<'a> {
    rays: &'a Rays,
    front: Point,
    near: &'a Near,
    to: &'a mut [f64],
}

impl WithSimd for Cast<'_> {
    type Output = ();

    #[inline(always)]
    #[expect(
        clippy::inline_always,
        reason = "else it is not compiled for the vectors at hand"
    )]
    fn with_simd<S: Simd>(self, simd: S) {
        let cosines = S::as_simd_f64s(self.rays.cosines.as_flattened()).0;
        let sines = S::as_simd_f64s(self.rays.sines.as_flattened()).0;
        let nearest = S::as_mut_simd_f64s(self.to).0;
        let front_x = simd.splat_f64s(self.front.x);
        let front_y = simd.splat_f64s(self.front.y);
        for ((cosine, sine), nearest) in cosines.iter().zip(sines).zip(nearest) {
            let x = simd.sub_f64s(
                simd.mul_f64s(*cosine, front_x),
                simd.mul_f64s(*sine, front_y),
            );
            let y = simd.add_f64s(
                simd.mul_f64s(*cosine, front_y),
                simd.mul_f64s(*sine, front_x),
            );
            let rays = [x, y];
            for disc in &self.near.discs[..self.near.disc_count] {
                meet_disc(simd, rays, disc, nearest);
            }
            for wall in &self.near.walls[..self.near.wall_count] {
                meet_wall(simd, rays, wall, nearest);
            }
        }
    }
}

/// A ray of direction u meets the disc about c at the lesser root of t^2 - 2 (u.c) t + power.
#[inline(always)]
#[expect(clippy::inline_always, reason = "as its caller")]
fn meet_disc<S: Simd>(simd: S, [x, y]: [S::f64s; 2], disc: &NearDisc, nearest: &mut S::f64s) {
    let centre_x = simd.splat_f64s(disc.centre.x);
    let centre_y = simd.splat_f64s(disc.centre.y);
    let ahead = simd.add_f64s(simd.mul_f64s(x, centre_x), simd.mul_f64s(y, centre_y));
    let root = simd.sub_f64s(simd.mul_f64s(ahead, ahead), simd.splat_f64s(disc.power));
    let zero = simd.splat_f64s(0.0);
    let meets = simd.and_m64s(
        simd.greater_than_f64s(ahead, zero),
        simd.greater_than_or_equal_f64s(root, zero),
    );
    if simd.first_true_m64s(meets) < S::F64_LANES {
        let distance = simd.sub_f64s(ahead, simd.sqrt_f64s(root));
        let is_nearer = simd.and_m64s(meets, simd.less_than_f64s(distance, *nearest));
        *nearest = simd.select_f64s(is_nearer, distance, *nearest);
    }
}

/// A ray comes nearer to the wall's line by `approach` a metre, and meets it from the free side.
#[inline(always)]
#[expect(clippy::inline_always, reason = "as its caller")]
fn meet_wall<S: Simd>(simd: S, [x, y]: [S::f64s; 2], wall: &NearWall, nearest: &mut S::f64s) {
    let along_x = simd.splat_f64s(wall.along.x);
    let along_y = simd.splat_f64s(wall.along.y);
    let approach = simd.sub_f64s(simd.mul_f64s(x, along_y), simd.mul_f64s(y, along_x));
    let height = simd.splat_f64s(wall.height);
    let is_nearer = simd.less_than_f64s(height, simd.mul_f64s(approach, *nearest));
    if simd.first_true_m64s(is_nearer) < S::F64_LANES {
        let distance = simd.div_f64s(height, approach);
        let drift = simd.add_f64s(simd.mul_f64s(x, along_x), simd.mul_f64s(y, along_y));
        let place = simd.add_f64s(simd.splat_f64s(wall.foot), simd.mul_f64s(distance, drift));
        let is_on_wall = simd.and_m64s(
            simd.greater_than_or_equal_f64s(place, simd.splat_f64s(-CRACK_M)),
            simd.less_than_or_equal_f64s(place, simd.splat_f64s(wall.length + CRACK_M)),
        );
        let meets = simd.and_m64s(is_nearer, is_on_wall);
        *nearest = simd.select_f64s(meets, distance, *nearest);
    }
}

#[cfg(test)]
mod tests;
