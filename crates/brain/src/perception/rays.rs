//! The free space around a robot, from the rays of a range ring.
//!
//! Nothing is measured between two neighbouring rays. Free space is therefore the polygon through
//! the ends of the rays: a flat wall that two rays hit is exactly one of its sides, and without a
//! return it ends at the range of the sensor. [Corners](super::corners) of obstacles may be inside;
//! what is certain to be free is less. An obstacle thinner than the gap between rays may be inside
//! of that too.

use crate::io::body::RangeRing;
use crate::io::percept::Scan;
use crate::perception::chords::{Chord, Nearest, chords};
use crate::perception::corners::{Protrusion, Width};
use crate::perception::sector::{Sector, direction};
use alloc::vec::Vec;
use base::geometry::Point;
use base::trig::wrapped;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// A ring covers a direction if one of its rays is within this angle of it.
const COVERAGE_RAD: f64 = FRAC_PI_4 + 1e-9;

/// A scan expires after this number of scan periods.
const FRESH_SCANS: f64 = 3.0;

/// A range ring, with its precomputed geometry.
#[derive(Debug, Clone)]
pub(crate) struct Ring {
    range_m: f64,
    latency_s: f64,
    fresh_s: f64,
    bearings_rad: Vec<f64>,
    directions: Vec<Point>,
    /// Smallest angle between two neighbouring rays.
    gap_rad: f64,
    chords: Vec<Chord>,
    /// No chord is closer than this fraction of the shortest ray.
    nearest_share: f64,
    /// The greatest of all chords.
    protrusion: Protrusion,
    /// Number of chords, the first ones, that can lie ahead.
    ahead: usize,
    /// The area swept straight ahead.
    lane: Sector,
    /// Whether its rays cover the front, and the back.
    pub(crate) covers_front: bool,
    pub(crate) covers_back: bool,
}

/// Distances from the robot's centre to the nearest place that is not known to be free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Free {
    /// If walls are flat between two rays.
    pub(crate) flat_m: f64,
    /// If their corners may protrude.
    pub(crate) certain_m: f64,
}

impl Free {
    /// Both are the same.
    pub(crate) fn certain(certain_m: f64) -> Self {
        Self {
            flat_m: certain_m,
            certain_m,
        }
    }
}

/// One measured ray of a ring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// Angle from the robot's front, anticlockwise.
    pub(crate) bearing_rad: f64,
    /// Unit vector of the bearing.
    pub(crate) direction: Point,
    /// Its length.
    pub(crate) range_m: f64,
}

impl Ray {
    pub(crate) fn new(bearing_rad: f64, range_m: f64) -> Self {
        Self {
            bearing_rad,
            direction: direction(bearing_rad),
            range_m,
        }
    }

    /// Its end in the robot's frame.
    #[inline]
    pub(crate) fn end(&self) -> Point {
        self.direction.times(self.range_m)
    }
}

/// The free distance along each ray: the minimum of its range and those of both neighbours.
///
/// A ray that passes a wall at a small angle crosses cells that the wall partly fills, where the
/// ray beside it ends.
pub(crate) fn free_ranges_m(ranges_m: &[f64]) -> impl Iterator<Item = f64> {
    let at = |ray: usize| ranges_m.get(ray).copied().unwrap_or(f64::INFINITY);
    (0..ranges_m.len()).map(move |ray| {
        let before_m = ray.checked_sub(1).map_or(f64::INFINITY, at);
        at(ray).min(before_m).min(at(ray + 1))
    })
}

impl Ring {
    /// The ring on a body of this width, with a brain of this period.
    pub(crate) fn new(ring: &RangeRing, width: Width, period_s: f64) -> Self {
        let mut chords = chords(&ring.bearings_rad);
        for chord in &mut chords {
            chord.protrusion = Protrusion::new(chord.gap_rad, width);
            chord.beside_m = chord.beside_m(width.half_width_m, ring.range_m);
        }
        chords.sort_by(|a, b| a.off_front_rad.total_cmp(&b.off_front_rad));
        let covers = |towards_rad: f64| {
            let off = |bearing: &f64| wrapped(bearing - towards_rad).abs();
            ring.bearings_rad
                .iter()
                .any(|bearing| off(bearing) <= COVERAGE_RAD)
        };
        Self {
            range_m: ring.range_m,
            latency_s: ring.latency_s.max(0.0),
            fresh_s: ring.latency_s + FRESH_SCANS * ring.period_s + period_s,
            bearings_rad: ring.bearings_rad.clone(),
            directions: ring.bearings_rad.iter().copied().map(direction).collect(),
            gap_rad: chords
                .iter()
                .map(|chord| chord.gap_rad)
                .fold(COVERAGE_RAD, f64::min),
            ahead: chords.partition_point(|chord| chord.off_front_rad < FRAC_PI_2),
            nearest_share: chords
                .iter()
                .map(|chord| chord.nearest_share)
                .fold(1.0, f64::min),
            protrusion: chords
                .iter()
                .map(|chord| chord.protrusion)
                .fold(Protrusion::default(), Protrusion::or),
            chords,
            lane: Sector::new(0.0, 0.0, width.half_width_m),
            covers_front: covers(0.0),
            covers_back: covers(PI),
        }
    }

    /// Age and ranges of a scan, if it is complete and not expired.
    #[inline]
    pub(crate) fn fresh<'p>(&self, scan: Option<&'p Scan>) -> Option<(f64, &'p [f64])> {
        self.complete(scan)
            .filter(|(age_s, _)| self.is_fresh(*age_s))
    }

    /// Whether a scan of an age is not expired.
    #[inline]
    pub(crate) fn is_fresh(&self, age_s: f64) -> bool {
        age_s <= self.fresh_s
    }

    /// Age and ranges of a scan, if it is complete; it may be of any age.
    #[inline]
    pub(crate) fn complete<'p>(&self, scan: Option<&'p Scan>) -> Option<(f64, &'p [f64])> {
        let scan = scan?;
        let age_s = scan.age_s.filter(|age_s| *age_s >= 0.0)?;
        let age_s = age_s.max(self.latency_s);
        let is_complete = scan.ranges_m.len() == self.bearings_rad.len();
        is_complete.then_some((age_s, &scan.ranges_m))
    }

    /// All rays, limited to the range of the sensor.
    #[inline]
    pub(crate) fn rays(&self, ranges_m: &[f64]) -> impl Iterator<Item = Ray> {
        let bearings = self.bearings_rad.iter().zip(&self.directions);
        let rays = bearings.zip(ranges_m);
        rays.map(|((bearing_rad, direction), range_m)| Ray {
            bearing_rad: *bearing_rad,
            direction: *direction,
            range_m: lesser(valid_m(*range_m), self.range_m),
        })
    }

    /// Whether the first and the last ray are neighbours.
    pub(crate) fn is_round(&self) -> bool {
        let ends = self.bearings_rad.first().zip(self.bearings_rad.last());
        ends.is_some_and(|(first, last)| wrapped(first - last).abs() <= 1.5 * self.gap_rad)
    }

    /// Time from a scan until the brain receives it.
    pub(crate) fn latency_s(&self) -> f64 {
        self.latency_s
    }

    /// Maximum range of the sensor.
    pub(crate) fn range_m(&self) -> f64 {
        self.range_m
    }

    /// Measured range of a ray, limited to the range of the sensor.
    #[inline]
    pub(crate) fn ray_m(&self, ranges_m: &[f64], ray: usize) -> f64 {
        let measured_m = ranges_m.get(ray).copied().unwrap_or_default();
        lesser(valid_m(measured_m), self.range_m)
    }

    /// A bearing beside a ray, offset by a fraction of the angle between rays.
    pub(crate) fn bearing_beside_rad(&self, ray: usize, share: f64) -> f64 {
        let bearing_rad = self.bearings_rad.get(ray).copied().unwrap_or_default();
        bearing_rad + share * self.gap_rad
    }

    /// Lower bound of the distance from the robot's centre to the nearest obstacle whose corners may
    /// protrude between rays.
    #[inline]
    pub(crate) fn nearest_m(&self, ranges_m: &[f64]) -> f64 {
        let nearest_m = ranges_m.iter().fold(self.range_m, |nearest_m, range_m| {
            lesser(valid_m(*range_m), nearest_m)
        });
        nearest_m * self.nearest_share - self.protrusion.at_m(nearest_m)
    }

    /// The free distances straight ahead.
    ///
    /// It runs in every step. Chords beside the swept area are skipped at once, and beyond half the
    /// sensor's range a chord counts as being as close as its rays allow. Whether a chord is closer
    /// than that is unpredictable, and a mispredicted branch would cost more than all the rest:
    /// therefore the first pass decides it for all chords without branches, and the second examines
    /// the close ones.
    #[inline]
    pub(crate) fn free_ahead(&self, ranges_m: &[f64]) -> Free {
        let (mut far, mut flat, mut certain) = (
            Nearest::new(self.range_m),
            Nearest::new(self.range_m),
            Nearest::new(self.range_m),
        );
        let is_flat = self.protrusion.is_flat();
        let chords = self.chords.get(..self.ahead).unwrap_or_default();
        for chords in chords.chunks(64) {
            let mut near = self.bound_far(chords, ranges_m, &mut far);
            while let Some(chord) = chords.get(near.trailing_zeros() as usize) {
                let ends_m = chord.rays.map(|ray| self.ray_m(ranges_m, ray));
                let protrusion_m = chord.protrusion.at_m(lesser(ends_m[0], ends_m[1]));
                if is_flat || certain.update(chord, ends_m, protrusion_m, &self.lane) {
                    flat.update(chord, ends_m, 0.0, &self.lane);
                }
                near &= near - 1;
            }
        }
        let far_m = far.m();
        let flat_m = lesser(flat.m(), far_m);
        if is_flat {
            return Free::certain(flat_m);
        }
        // The nearest far chord is also the one from which a corner may protrude nearest.
        let certain_far_m = far_m - self.protrusion.at_m(far_m / self.nearest_share);
        Free {
            flat_m,
            certain_m: lesser(certain.m(), certain_far_m),
        }
    }

    /// Bounds the distance of far chords; returns the near ones as bits.
    #[inline]
    #[expect(
        clippy::needless_bitwise_bool,
        reason = "a branch would be mispredicted"
    )]
    fn bound_far(&self, chords: &[Chord], ranges_m: &[f64], nearest: &mut Nearest) -> u64 {
        let far_m = self.range_m / 2.0;
        let mut near = 0;
        for (number, chord) in chords.iter().enumerate() {
            let [from, to] = chord.rays.map(|ray| ranges_m.get(ray).copied());
            let (Some(from), Some(to)) = (from, to) else {
                continue;
            };
            if from > chord.beside_m[0] && to > chord.beside_m[1] {
                continue;
            }
            let is_far = (from > far_m) & (to > far_m);
            let min_m = lesser(lesser(from, to), self.range_m) * chord.nearest_share;
            let squared_m2 = if is_far { min_m * min_m } else { f64::INFINITY };
            nearest.squared_m2 = lesser(squared_m2, nearest.squared_m2);
            near |= u64::from(!is_far) << number;
        }
        near
    }

    /// Distance from the robot's centre to the nearest place in a sector that is not certain to be
    /// free.
    pub(crate) fn free_m(&self, ranges_m: &[f64], sector: &Sector) -> f64 {
        let mut nearest = Nearest::new(self.range_m);
        for chord in &self.chords {
            let ends_m = chord.rays.map(|ray| self.ray_m(ranges_m, ray));
            let protrusion_m = chord.protrusion.at_m(lesser(ends_m[0], ends_m[1]));
            nearest.update(chord, ends_m, protrusion_m, sector);
        }
        nearest.m()
    }
}

/// The range to use for a measured value: an invalid one counts as an obstacle at distance 0, which
/// is the safe assumption.
#[inline]
pub(crate) fn valid_m(measured_m: f64) -> f64 {
    if measured_m > 0.0 { measured_m } else { 0.0 }
}

/// The smaller of two numbers; without the handling of NaN that `min` has.
#[inline]
fn lesser(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use crate::world_of_walls::{Walk, ring, rover, square};
    use proptest::prelude::*;

    /// A clearance that covers every corner: walls are flat.
    const FLAT: Width = Width {
        half_width_m: 0.25,
        clearance_m: f64::INFINITY,
    };

    const AHEAD: (f64, f64) = (0.0, 0.0);

    fn free_m(ring: &RangeRing, ranges_m: &[f64], (from, to): (f64, f64)) -> f64 {
        Ring::new(ring, FLAT, 0.1).free_m(ranges_m, &Sector::new(from, to, 0.25))
    }

    #[test]
    fn the_distance_of_a_wall_ahead_is_that_of_its_ray() {
        let mut ranges = [f64::INFINITY; 16];
        ranges[0] = 1.0;
        assert!((free_m(&ring(16, 3.0), &ranges, AHEAD) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_wall_behind_does_not_limit_the_free_distance_ahead() {
        let mut ranges = [f64::INFINITY; 16];
        ranges[5..=11].fill(0.3);
        let ring = ring(16, 3.0);
        assert!(free_m(&ring, &ranges, AHEAD) > 2.9);
        assert!((free_m(&ring, &ranges, (PI, PI)) - 0.3 * (PI / 16.0).cos()).abs() < 1e-12);
    }

    #[test]
    fn walls_of_a_lane_wider_than_the_body_leave_it_free() {
        let lane = |half_width: f64| -> Vec<f64> {
            let bearings = ring(64, 30.0).bearings_rad;
            let ranges = bearings
                .iter()
                .map(|bearing| half_width / bearing.sin().abs());
            ranges.collect()
        };
        assert!(free_m(&ring(64, 30.0), &lane(0.26), AHEAD) > 2.0);
        assert!(free_m(&ring(64, 30.0), &lane(0.24), AHEAD) < 0.25);
    }

    #[test]
    fn nothing_is_free_beyond_the_sensors_range() {
        for rays in [1, 4, 8, 16, 360] {
            let ranges = vec![f64::INFINITY; rays];
            let free = free_m(&ring(rays, 3.0), &ranges, AHEAD);
            assert!((2.7..=3.0).contains(&free), "{rays} rays: {free}");
        }
    }

    #[test]
    fn a_curve_to_the_left_is_limited_by_obstacles_on_the_left() {
        let mut ranges = [f64::INFINITY; 16];
        ranges[3] = 1.0;
        let ring = ring(16, 3.0);
        assert!(free_m(&ring, &ranges, AHEAD) > 2.0);
        assert!((free_m(&ring, &ranges, (0.0, FRAC_PI_2)) - 1.0).abs() < 0.1);
        assert!(free_m(&ring, &ranges, (-FRAC_PI_2, 0.0)) > 2.0);
    }

    #[test]
    fn the_protrusion_of_a_corner_shortens_what_is_certainly_free() {
        let width = Width {
            half_width_m: 0.2625,
            clearance_m: 0.0125,
        };
        let ring = ring(180, 8.0);
        let mut ranges = [f64::INFINITY; 180];
        ranges[179] = 2.0;
        ranges[..=1].fill(2.0);
        let free = Ring::new(&ring, width, 0.1).free_ahead(&ranges);
        let protrusion_m = 2.0 * (2.0 * PI / 180.0).sin() - 0.0125;
        assert!((free.flat_m - 2.0).abs() < 0.001, "{free:?}");
        assert!((free.flat_m - free.certain_m - protrusion_m).abs() < 1e-3);
    }

    proptest! {
        #[test]
        fn the_certainly_free_distance_to_a_corner_is_never_too_long(
            box_m in (0.4..6.0_f64, -0.5..0.5_f64), course_rad in -3.1..3.1_f64, rays in 132_usize..400,
        ) {
            let (radius_m, half_width_m) = (0.25, 0.2625);
            let (x, y) = box_m;
            let walls = square(Point { x, y }, course_rad, 0.5);
            let ring = ring(rays, 8.0);
            let mut walk = Walk::new(Body { rings: vec![ring.clone()], ..rover() }, walls.clone(), [0.0; 2], 0.0);
            let gap_m = |x: f64| {
                let at = Point { x, y: 0.0 };
                walls.iter().map(|wall| wall.distance_m(at)).fold(f64::INFINITY, f64::min) - radius_m
            };
            prop_assume!(gap_m(0.0) > 0.0);
            let ranges_m = walk.percept().scans.remove(0).ranges_m;
            let width = Width { half_width_m, clearance_m: half_width_m - radius_m };
            let certain_m = Ring::new(&ring, width, 0.1).free_ahead(&ranges_m).certain_m;
            let steps = (0..800).map(|step| 0.01 * f64::from(step));
            let contact_m = steps.take_while(|x| gap_m(*x) > 0.0).last().unwrap() + 0.01;
            prop_assert!(certain_m - half_width_m <= contact_m, "{certain_m} {contact_m}");
        }

        #[test]
        fn the_free_distance_to_a_flat_wall_is_never_too_long(
            wall_m in 0.3..3.0_f64, normal_rad in -1.5..1.5_f64, rays in 8_usize..64,
        ) {
            let ring = ring(rays, 4.0);
            let range = |bearing: &f64| {
                let towards = (bearing - normal_rad).cos();
                if towards > 0.0 && wall_m / towards < 4.0 { wall_m / towards } else { f64::INFINITY }
            };
            let ranges: Vec<f64> = ring.bearings_rad.iter().map(range).collect();
            // The disc touches the wall when its centre is one radius away.
            let contact_m = (wall_m - 0.25) / normal_rad.cos();
            prop_assert!(free_m(&ring, &ranges, AHEAD) - 0.25 <= contact_m + 1e-9);
        }
    }
}
