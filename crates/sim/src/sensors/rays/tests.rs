use super::*;
use base::geometry::Segment;
use base::random::{Entity, Purpose, Stream, stream, unit};
use base::trig::sin_cos;
use proptest::prelude::*;
use pulp::{Arch, WithSimd};
use std::f64::consts::{PI, TAU};

/// The distance, in lengths of `direction`, at which the ray from `origin` meets the free side of a
/// wall; the solid side, and a ray along the wall, meet nothing. An end on the ray counts for both
/// sides, so that a ray between two walls with a common end meets one of them.
fn hit(wall: &Segment, origin: Point, direction: Point) -> Option<f64> {
    let (from, to) = (origin.to(wall.from), origin.to(wall.to));
    let (right, left) = (direction.cross(from), direction.cross(to));
    let comes_from_free = right <= 0.0 && left >= 0.0 && left > right;
    let ahead = (direction.dot(from) * left - direction.dot(to) * right)
        / ((left - right) * direction.length_squared());
    (comes_from_free && ahead >= 0.0).then_some(ahead)
}

fn between(random: &mut Stream, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(random)
}

fn random(scene: u64) -> Stream {
    stream(5, scene, Entity { kind: 0, index: 0 }, Purpose::Item)
}

struct Cast<'a> {
    rays: &'a Rays,
    front: Point,
    near: &'a Near,
    range_m: f64,
    to: &'a mut [[f64; GROUP]],
}

impl WithSimd for Cast<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.rays
            .cast(simd, (self.front, self.range_m), self.near, self.to);
    }
}

/// Walls and discs, a place from which rays go, and how far.
struct Scene {
    at: Point,
    walls: Vec<Segment>,
    discs: Vec<Disc>,
    range_m: f64,
}

impl Scene {
    /// Something to see on all scales; the place is in no disc.
    fn new(random: &mut Stream) -> Self {
        let side_m = [1.0, 20.0, 3000.0][random.bounded(3) as usize];
        let mut point = || Point {
            x: side_m * unit(random),
            y: side_m * unit(random),
        };
        let at = point();
        let walls = (0..8).map(|_| Segment {
            from: point(),
            to: point(),
        });
        let walls = walls.collect();
        let centres: Vec<Point> = (0..8).map(|_| point()).collect();
        let discs = centres.iter().map(|centre| {
            let max_m = (0.3 * side_m).min(at.to(*centre).length());
            Disc {
                centre: *centre,
                radius_m: max_m * unit(random),
            }
        });
        Self {
            at,
            walls,
            discs: discs.collect(),
            range_m: between(random, 0.05, 1.0) * side_m,
        }
    }

    /// Those that overlap no other, and the others.
    fn discs(&self) -> [Vec<Disc>; 2] {
        let overlaps = |disc: &&Disc| {
            let mut others = self.discs.iter().filter(|other| *other != *disc);
            others.any(|other| disc.distance_m(other.centre) < other.radius_m)
        };
        let (overlapping, apart) = self.discs.iter().partition(overlaps);
        [apart, overlapping]
    }

    fn cast(&self, front: Point, bearings_rad: &[f64]) -> Vec<f64> {
        let walls: Vec<Wall> = self.walls.iter().filter_map(Wall::of).collect();
        let (mut near, mut ranges_m) = (Near::default(), vec![7.0; 3]);
        // What an earlier place has left there does not matter.
        let [apart, overlapping] = self.discs();
        for (at, range_m) in [(Point::default(), 1e9), (self.at, self.range_m)] {
            near.begin(at, range_m);
            // In two parts, as for other robots and static obstacles.
            for apart in apart.chunks(2) {
                near.take_apart(apart.iter().copied());
            }
            near.take_overlapping(overlapping.iter().copied());
            near.take_walls(walls.iter());
        }
        let rays = Rays::new(bearings_rad);
        ranges_m.resize(rays.groups() * GROUP, 7.0);
        Arch::new().dispatch(Cast {
            rays: &rays,
            front,
            near: &near,
            range_m: self.range_m,
            to: ranges_m.as_chunks_mut().0,
        });
        ranges_m.truncate(bearings_rad.len());
        ranges_m
    }

    /// The distance at which a ray meets the first thing, all held against it one by one.
    fn plain(&self, direction: Point) -> f64 {
        let walls = self
            .walls
            .iter()
            .filter_map(|wall| hit(wall, self.at, direction));
        let discs = self.discs.iter().filter_map(|disc| {
            let ahead = direction.dot(self.at.to(disc.centre));
            let beside = direction.cross(self.at.to(disc.centre));
            let half_chord = (disc.radius_m - beside) * (disc.radius_m + beside);
            (ahead > 0.0 && half_chord >= 0.0).then(|| ahead - half_chord.sqrt())
        });
        walls.chain(discs).fold(self.range_m, f64::min)
    }

    /// Whether the distance is another if the ray is turned by a hair: it grazes something.
    fn is_grazing(&self, direction: Point) -> bool {
        let turned = |angle: f64| {
            let (y, x) = sin_cos(angle);
            self.plain(Point {
                x: direction.x * x - direction.y * y,
                y: direction.y * x + direction.x * y,
            })
        };
        let straight = self.plain(direction);
        let scale = self.range_m;
        [-1e-9, 1e-9]
            .iter()
            .any(|angle| (turned(*angle) - straight).abs() > 1e-6 * scale)
    }
}

#[test]
fn rays_agree_with_a_plain_version_in_thousands_of_scenes() {
    let (mut compared, mut grazing, mut met) = (0, 0, 0);
    for number in 0..4000 {
        let mut random = random(number);
        let scene = Scene::new(&mut random);
        let rays = 1 + random.bounded(40);
        let bearings_rad: Vec<f64> = (0..rays).map(|_| between(&mut random, -PI, PI)).collect();
        let heading_rad = between(&mut random, -PI, PI);
        let (y, x) = sin_cos(heading_rad);
        let ranges_m = scene.cast(Point { x, y }, &bearings_rad);
        assert_eq!(ranges_m.len(), bearings_rad.len());
        for (range_m, bearing_rad) in ranges_m.iter().zip(&bearings_rad) {
            let (y, x) = sin_cos(heading_rad + bearing_rad);
            let direction = Point { x, y };
            compared += 1;
            if scene.is_grazing(direction) {
                grazing += 1;
                continue;
            }
            let plain_m = scene.plain(direction);
            met += u32::from(plain_m < scene.range_m);
            let error_m = (range_m - plain_m).abs();
            assert!(
                error_m <= 1e-9 * scene.range_m.max(1.0),
                "{number}: {range_m} {plain_m}"
            );
        }
    }
    // The seeds are fixed, so these are: the comparison is of something, and of almost all.
    assert!(
        grazing * 1000 < compared && met * 3 > compared,
        "{grazing} {met} {compared}"
    );
}

/// A ring of as many rays about a robot at a place, that looks along x.
fn ring(count: u32) -> Vec<f64> {
    (0..count)
        .map(|ray| TAU * f64::from(ray) / f64::from(count) - PI)
        .collect()
}

const AHEAD: Point = Point { x: 1.0, y: 0.0 };

fn square(side_m: f64) -> Vec<Segment> {
    let half = side_m / 2.0;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]].map(Point::from);
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(&from, &to)| Segment { from, to })
        .collect()
}

#[test]
fn a_wall_is_seen_from_its_free_side_only() {
    let wall = |from: [f64; 2], to: [f64; 2]| Segment {
        from: from.into(),
        to: to.into(),
    };
    let mut scene = Scene {
        at: Point { x: 1.0, y: 1.0 },
        walls: vec![wall([3.0, 0.0], [3.0, 2.0])],
        discs: Vec::new(),
        range_m: 10.0,
    };
    assert_eq!(scene.cast(AHEAD, &[0.0]), [2.0]);
    scene.walls = vec![wall([3.0, 2.0], [3.0, 0.0])];
    assert_eq!(scene.cast(AHEAD, &[0.0]), [10.0]);
    // A wall behind, or one along the ray, is not seen either.
    scene.walls = vec![wall([0.0, 0.0], [0.0, 2.0]), wall([2.0, 1.0], [3.0, 1.0])];
    assert_eq!(scene.cast(AHEAD, &[0.0]), [10.0]);
}

proptest! {
    #[test]
    fn no_ray_gets_out_of_a_closed_room_of_many_walls(
        corners in 3_u32..60, size in 0.1..5e4_f64, offset in -5e4..5e4_f64, heading in -PI..PI,
        inside in 0.0..0.4, towards in -PI..PI,
    ) {
        let at = |angle: f64| Point {
            x: offset + size * libm::cos(angle),
            y: 3.0 + size * libm::sin(angle),
        };
        let turn = TAU / f64::from(corners);
        let corner = |number: u32| at(heading + turn * f64::from(number % corners));
        let walls = (0..corners).map(|number| Segment { from: corner(number), to: corner(number + 1) });
        let middle = Point { x: offset, y: 3.0 };
        let scene = Scene {
            at: middle.plus(middle.to(at(towards)).times(inside)),
            walls: walls.collect(),
            discs: Vec::new(),
            range_m: 3.0 * size,
        };
        // Rays anywhere, and straight at the corners, where walls adjoin.
        let mut bearings_rad = ring(64);
        bearings_rad.extend((0..corners).map(|number| {
            let way = scene.at.to(corner(number));
            libm::atan2(way.y, way.x)
        }));
        let ranges_m = scene.cast(AHEAD, &bearings_rad);
        prop_assert!(ranges_m.iter().all(|range_m| *range_m <= 2.0 * size), "{ranges_m:?}");
    }

    #[test]
    fn what_is_beyond_the_range_changes_nothing(range in 0.5..4.0_f64, beyond in 1e-6..5.0_f64) {
        let mut scene = Scene {
            at: Point::default(),
            walls: square(4.0),
            discs: Vec::new(),
            range_m: range,
        };
        let alone = scene.cast(AHEAD, &ring(40));
        scene.discs = (0..8).map(|number| {
            let (y, x) = sin_cos(f64::from(number));
            Disc { centre: Point { x, y }.times(range + beyond + 0.5), radius_m: 0.5 }
        }).collect();
        prop_assert_eq!(alone, scene.cast(AHEAD, &ring(40)));
    }
}

#[test]
fn a_room_measures_as_wide_as_it_is() {
    let scene = Scene {
        at: Point { x: 0.5, y: 0.0 },
        walls: square(4.0),
        discs: vec![Disc {
            centre: Point { x: 0.5, y: 1.5 },
            radius_m: 0.25,
        }],
        range_m: 100.0,
    };
    let ranges_m = scene.cast(AHEAD, &[0.0, PI, PI / 2.0, -PI / 2.0, PI / 4.0]);
    let expected_m = [1.5, 2.5, 1.25, 2.0, 1.5 * 2.0_f64.sqrt()];
    for (range_m, expected_m) in ranges_m.iter().zip(expected_m) {
        assert!((range_m - expected_m).abs() < 1e-12, "{ranges_m:?}");
    }
}

/// External bodies can be anywhere, and may overlap.
#[test]
fn one_in_a_disc_sees_it_at_no_distance() {
    let scene = Scene {
        at: Point { x: 0.1, y: 0.0 },
        walls: Vec::new(),
        discs: vec![Disc {
            centre: Point { x: 0.3, y: 0.0 },
            radius_m: 0.5,
        }],
        range_m: 3.0,
    };
    let ranges_m = scene.cast(AHEAD, &ring(32));
    assert!(
        ranges_m.iter().all(|range_m| *range_m >= 0.0),
        "{ranges_m:?}"
    );
    assert_eq!(scene.cast(AHEAD, &[0.0]), [0.0]);
}
