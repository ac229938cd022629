//! Sixteen rays, fixed in the frame of every robot, cast against its neighbours in that frame.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use super::constants::RANGE_M;
use pulp::Simd;

/// Rays in two groups, the front one first, anticlockwise.
pub(super) type Rays = [[f64; 8]; 2];

#[derive(Clone, Copy, Default)]
pub(super) struct NearDisc {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Square of the distance less that of the radius.
    pub(super) power: f64,
}

#[derive(Clone, Copy, Default)]
pub(super) struct NearWall {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// Their cross product.
    pub(super) area: f64,
}

/// Cosines and sines of the rays.
pub(super) fn directions() -> [Rays; 2] {
    let angle = |group: u32, lane: u32| f64::from(8 * group + lane) * std::f64::consts::FRAC_PI_8;
    let rays = |part: fn((f64, f64)) -> f64| {
        [0, 1].map(|group| {
            [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| part(base::trig::sin_cos(angle(group, lane))))
        })
    };
    [rays(|(_, cosine)| cosine), rays(|(sine, _)| sine)]
}

#[expect(clippy::too_many_arguments, reason = "they lie in different places")]
#[inline(always)]
pub(super) fn cast<S: Simd>(
    simd: S,
    [cosines, sines]: &[Rays; 2],
    discs: &[NearDisc],
    walls: &[NearWall],
    hits: &mut [u32],
    ranges: &mut Rays,
) {
    let cosines = S::as_simd_f64s(cosines.as_flattened()).0;
    let sines = S::as_simd_f64s(sines.as_flattened()).0;
    let ranges = S::as_mut_simd_f64s(ranges.as_flattened_mut()).0;
    for ((x, y), range) in cosines.iter().zip(sines).zip(ranges) {
        let rays = [*x, *y];
        let mut nearest = simd.splat_f64s(RANGE_M);
        let mut found = 0;
        for (number, disc) in (0..).zip(discs) {
            let (meets, ..) = disc_meets(simd, rays, disc);
            hits[found] = number;
            found += usize::from(simd.first_true_m64s(meets) < S::F64_LANES);
        }
        for number in &hits[..found] {
            let (meets, ahead, root) = disc_meets(simd, rays, &discs[*number as usize]);
            let range = simd.sub_f64s(ahead, simd.sqrt_f64s(root));
            let is_nearer = simd.and_m64s(meets, simd.less_than_f64s(range, nearest));
            nearest = simd.select_f64s(is_nearer, range, nearest);
        }
        found = 0;
        for (number, wall) in (0..).zip(walls) {
            let (meets, _) = wall_meets(simd, rays, wall, nearest);
            hits[found] = number;
            found += usize::from(simd.first_true_m64s(meets) < S::F64_LANES);
        }
        for number in &hits[..found] {
            let wall = &walls[*number as usize];
            let (meets, span) = wall_meets(simd, rays, wall, nearest);
            let range = simd.div_f64s(simd.splat_f64s(wall.area), span);
            nearest = simd.select_f64s(meets, range, nearest);
        }
        *range = nearest;
    }
}

#[inline(always)]
fn disc_meets<S: Simd>(
    simd: S,
    [x, y]: [S::f64s; 2],
    disc: &NearDisc,
) -> (S::m64s, S::f64s, S::f64s) {
    let ahead = simd.add_f64s(
        simd.mul_f64s(x, simd.splat_f64s(disc.x)),
        simd.mul_f64s(y, simd.splat_f64s(disc.y)),
    );
    let root = simd.sub_f64s(simd.mul_f64s(ahead, ahead), simd.splat_f64s(disc.power));
    let zero = simd.splat_f64s(0.0);
    let meets = simd.and_m64s(
        simd.greater_than_f64s(ahead, zero),
        simd.greater_than_or_equal_f64s(root, zero),
    );
    (meets, ahead, root)
}

#[inline(always)]
fn wall_meets<S: Simd>(
    simd: S,
    [x, y]: [S::f64s; 2],
    wall: &NearWall,
    nearest: S::f64s,
) -> (S::m64s, S::f64s) {
    let from = simd.sub_f64s(
        simd.mul_f64s(x, simd.splat_f64s(wall.from[1])),
        simd.mul_f64s(y, simd.splat_f64s(wall.from[0])),
    );
    let to = simd.sub_f64s(
        simd.mul_f64s(x, simd.splat_f64s(wall.to[1])),
        simd.mul_f64s(y, simd.splat_f64s(wall.to[0])),
    );
    let span = simd.sub_f64s(to, from);
    let zero = simd.splat_f64s(0.0);
    let is_between = simd.and_m64s(
        simd.less_than_or_equal_f64s(from, zero),
        simd.greater_than_or_equal_f64s(to, zero),
    );
    let is_nearer = simd.less_than_f64s(simd.splat_f64s(wall.area), simd.mul_f64s(span, nearest));
    (simd.and_m64s(is_between, is_nearer), span)
}
