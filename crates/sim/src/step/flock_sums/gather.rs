//! Sums over runs of robots, in the widest vectors of the machine.
//!
//! Each run is processed in blocks of [`GROUP`] robots. **The order of each sum is fixed**: one sum
//! for each lane of a block, over the blocks in their order, and then over the lanes in pairs. It
//! uses only additions and products, none of them fused; a narrower vector processes the lanes part
//! by part. So all instruction sets give the same bits.

#![expect(
    clippy::inline_always,
    reason = "it is compiled for the vectors of its callers"
)]

use super::{Flock, Run};
use crate::sensors::range::instruction_set;
use crate::sensors::rays::GROUP;
use base::geometry::Point;
use brain::behaviours::flock::Sums;
use pulp::{Simd, WithSimd};
use std::array::from_fn;

/// Quantities that are summed: count, offsets, orientations, and offsets to those that are too
/// near.
const QUANTITIES: usize = 7;

impl Flock {
    /// Sums over the robots in range of each of the robots from place `first` on. For each kind
    /// `limits` gives the squares of its range and of the separation distance.
    pub(crate) fn sums(&self, first: usize, limits: impl Fn(u8) -> [f64; 2], to: &mut [Sums]) {
        instruction_set().dispatch(Gather {
            flock: self,
            first,
            limits,
            to,
        });
    }
}

/// The place to measure from, the limits, and the part of each block.
struct Query {
    at: Point,
    limits: [f64; 2],
    part: usize,
}

/// Sums for some robots, as one piece of work for vectors.
struct Gather<'a, L> {
    flock: &'a Flock,
    first: usize,
    limits: L,
    to: &'a mut [Sums],
}

impl<L: Fn(u8) -> [f64; 2]> WithSimd for Gather<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let flock = self.flock;
        let mut cell = flock
            .starts
            .partition_point(|start| *start as usize <= self.first)
            - 1;
        let mut runs = flock.runs(cell);
        for (place, to) in (self.first..).zip(self.to) {
            if flock.starts[cell + 1] as usize <= place {
                while flock.starts[cell + 1] as usize <= place {
                    cell += 1;
                }
                runs = flock.runs(cell);
            }
            let limits = (self.limits)(flock.kinds[place]);
            *to = flock.sums_of(simd, place, &runs.all[..runs.count], limits);
        }
    }
}

impl Flock {
    /// The robots in range of the robot at a place, except itself.
    #[inline(always)]
    fn sums_of<S: Simd>(&self, simd: S, place: usize, runs: &[Run], limits: [f64; 2]) -> Sums {
        let mut lanes = [[0.0; GROUP]; QUANTITIES];
        let parts = GROUP / S::F64_LANES;
        let at = Point {
            x: self.x[place],
            y: self.y[place],
        };
        for part in 0..parts {
            let query = Query { at, limits, part };
            let mut sums = [simd.splat_f64s(0.0); QUANTITIES];
            for run in runs {
                self.add_run(simd, run, &query, &mut sums);
            }
            for (lanes, sum) in lanes.iter_mut().zip(sums) {
                S::as_mut_simd_f64s(lanes).0[part] = sum;
            }
        }
        let [count, x, y, course_x, course_y, near_x, near_y] = lanes.map(total);
        let own = self.course(place);
        Sums {
            count: count - 1.0,
            way: Point { x, y },
            course: Point {
                x: course_x - own.x,
                y: course_y - own.y,
            },
            way_to_near: Point {
                x: near_x,
                y: near_y,
            },
        }
    }

    /// Adds one part of each block of a run.
    #[inline(always)]
    fn add_run<S: Simd>(
        &self,
        simd: S,
        run: &Run,
        query: &Query,
        sums: &mut [S::f64s; QUANTITIES],
    ) {
        let Query { at, limits, part } = *query;
        let blocks = run.start..run.start + (run.end - run.start).next_multiple_of(GROUP);
        let x = S::as_simd_f64s(&self.x[blocks.clone()]).0;
        let y = S::as_simd_f64s(&self.y[blocks.clone()]).0;
        let course_x = S::as_simd_f64s(&self.course_x[blocks.clone()]).0;
        let course_y = S::as_simd_f64s(&self.course_y[blocks]).0;
        let (at_x, at_y) = (
            simd.splat_f64s(at.x - run.shift.x),
            simd.splat_f64s(at.y - run.shift.y),
        );
        let [reach, near] = limits.map(|limit| simd.splat_f64s(limit));
        let (one, lane) = (simd.splat_f64s(1.0), S::as_simd_f64s(&LANES).0[part]);
        let parts = GROUP / S::F64_LANES;
        #[expect(clippy::cast_precision_loss, reason = "at most millions")]
        let mut left = (run.end - run.start) as f64;
        for block in (part..x.len()).step_by(parts) {
            let way_x = simd.sub_f64s(x[block], at_x);
            let way_y = simd.sub_f64s(y[block], at_y);
            let square = simd.add_f64s(simd.mul_f64s(way_x, way_x), simd.mul_f64s(way_y, way_y));
            let is_there = simd.less_than_f64s(lane, simd.splat_f64s(left));
            let is_in = simd.and_m64s(is_there, simd.less_than_or_equal_f64s(square, reach));
            let is_near = simd.and_m64s(is_in, simd.less_than_f64s(square, near));
            let in_range = [one, way_x, way_y, course_x[block], course_y[block]];
            let [all @ .., near_x, near_y] = sums;
            for (sum, value) in all.iter_mut().zip(in_range) {
                *sum = simd.select_f64s(is_in, simd.add_f64s(*sum, value), *sum);
            }
            *near_x = simd.select_f64s(is_near, simd.add_f64s(*near_x, way_x), *near_x);
            *near_y = simd.select_f64s(is_near, simd.add_f64s(*near_y, way_y), *near_y);
            left -= GROUP_LENGTH;
        }
    }
}

/// The sum of all lanes, in pairs.
#[inline(always)]
fn total(lanes: [f64; GROUP]) -> f64 {
    let fours: [f64; 4] = from_fn(|lane| lanes[lane] + lanes[lane + 4]);
    (fours[0] + fours[2]) + (fours[1] + fours[3])
}

/// The number of each lane of a block, and how many there are.
const LANES: [f64; GROUP] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
const GROUP_LENGTH: f64 = LANES[GROUP - 1] + 1.0;
