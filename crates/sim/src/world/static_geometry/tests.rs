use super::*;
use base::random::{Entity, Purpose, Stream, stream, unit};

struct Scene {
    size: Point,
    walls: Vec<Segment>,
    discs: Vec<Disc>,
}

impl Scene {
    /// A walled world with walls, discs and thin obstacles in it.
    fn new(random: &mut Stream) -> Self {
        let side_m = [0.5, 10.0, 80.0][random.bounded(3) as usize];
        let size = Point {
            x: side_m,
            y: side_m * (0.2 + unit(random)),
        };
        let mut point = || Point {
            x: size.x * unit(random),
            y: size.y * unit(random),
        };
        let mut walls = Rectangle::spanned(Point::default(), size).room().to_vec();
        for _ in 0..6 {
            let (from, to) = (point(), point());
            walls.push(Segment { from, to });
            let along = Point { x: to.x, y: from.y };
            walls.push(Segment { from, to: along });
        }
        let centres: Vec<Point> = (0..4).map(|_| point()).collect();
        let discs = centres.into_iter().map(|centre| Disc {
            centre,
            radius_m: 0.1 * side_m * unit(random),
        });
        Self {
            size,
            walls,
            discs: discs.collect(),
        }
    }

    fn geometry(&self, reach_m: f64) -> StaticGeometry {
        let walls: Vec<Wall> = self.walls.iter().filter_map(Wall::of).collect();
        StaticGeometry::new(self.size, &walls, &self.discs, reach_m)
    }

    /// Whether a segment is free, by checking everything; `None` where rounding decides.
    fn plain(&self, from: Point, to: Point) -> Option<bool> {
        let hair = 1e-9 * self.size.x * self.size.x;
        let side = |a: Point, b: Point, c: Point| a.to(b).cross(a.to(c));
        let mut is_open = true;
        for wall in &self.walls {
            let sides = [
                side(from, to, wall.from),
                side(from, to, wall.to),
                side(wall.from, wall.to, from),
                side(wall.from, wall.to, to),
            ];
            let crosses = |sides: &[f64]| (sides[0] > 0.0) != (sides[1] > 0.0);
            let is_crossed = crosses(&sides[..2]) && crosses(&sides[2..]);
            if sides.iter().any(|side| side.abs() < hair) {
                return None;
            }
            is_open &= !is_crossed;
        }
        for disc in &self.discs {
            let gap_m = Segment { from, to }.distance_m(disc.centre) - disc.radius_m;
            if gap_m.abs() < 1e-9 * self.size.x {
                return None;
            }
            is_open &= gap_m > 0.0;
        }
        Some(is_open)
    }
}

fn random(scene: u64) -> Stream {
    stream(4, scene, Entity { kind: 0, index: 0 }, Purpose::Item)
}

#[test]
fn a_way_is_open_if_nothing_at_all_crosses_it() {
    let (mut open, mut shut) = (0, 0);
    for number in 0..1500 {
        let mut random = random(number);
        let scene = Scene::new(&mut random);
        let reach_m = [0.0, 0.02, 1.0][random.bounded(3) as usize] * scene.size.x;
        let geometry = scene.geometry(reach_m);
        for _ in 0..10 {
            let mut point = || Point {
                x: scene.size.x * unit(&mut random),
                y: scene.size.y * unit(&mut random),
            };
            let (from, mut to) = (point(), point());
            match random.bounded(6) {
                0 => to.x = from.x,
                1 => to.y = from.y,
                2 => to = from.plus(from.to(to).times(0.05)),
                // One is outside, as external bodies can be: the border is between.
                3 => {
                    to = to.plus(Point {
                        x: 1.5 * scene.size.x,
                        y: 0.0,
                    });
                }
                4 => to = to.plus(Point { x: 0.3, y: -2.0 }.times(scene.size.y)),
                _ => {}
            }
            let Some(is_open) = scene.plain(from, to) else {
                continue;
            };
            assert_eq!(
                geometry.is_open(from, to),
                is_open,
                "{number}: {from:?} {to:?}"
            );
            let around = geometry.around(from, from.to(to).length());
            let share = around.open_share(to);
            assert_eq!(share >= 1.0, is_open, "{number}: {from:?} {to:?} {share}");
            for (part, is_open) in [(0.999, true), (1.001, false)] {
                let end = from.plus(from.to(to).times(share * part));
                let is_reported = share * part < 1.0 && scene.plain(from, end).is_some();
                assert!(
                    !is_reported || geometry.is_open(from, end) == is_open,
                    "{number}: {share}"
                );
            }
            assert_eq!(
                geometry.is_open(to, from),
                is_open,
                "{number}: {to:?} {from:?}"
            );
            open += u32::from(is_open);
            shut += u32::from(!is_open);
        }
    }
    assert!(open > 2000 && shut > 5000, "{open} {shut}");
}

fn room() -> StaticGeometry {
    let size = Point { x: 4.0, y: 3.0 };
    let room = Rectangle::spanned(Point::default(), size).room();
    let walls: Vec<Wall> = room.iter().filter_map(Wall::of).collect();
    StaticGeometry::new(size, &walls, &[], 0.5)
}

#[test]
fn what_lies_on_a_wall_is_in_sight() {
    let middle = Point { x: 2.0, y: 1.5 };
    for on_border in [
        [0.0, 1.0],
        [4.0, 2.9],
        [1.3, 0.0],
        [0.7, 3.0],
        [0.0, 0.0],
        [4.0, 3.0],
    ] {
        let place = Point::from(on_border);
        assert!(room().is_open(middle, place), "{place:?}");
        assert!(room().is_open(place, middle), "{place:?}");
    }
}

#[test]
fn a_way_of_no_length_is_open() {
    let middle = Point { x: 2.0, y: 1.5 };
    assert!(room().is_open(middle, middle));
}

#[test]
fn a_wall_hides_from_both_of_its_sides() {
    let size = Point { x: 4.0, y: 3.0 };
    let segment = Segment {
        from: [2.0, 0.0].into(),
        to: [2.0, 3.0].into(),
    };
    let walls: Vec<Wall> = Wall::of(&segment).into_iter().collect();
    let geometry = StaticGeometry::new(size, &walls, &[], 0.5);
    let (left, right) = (Point { x: 1.0, y: 1.0 }, Point { x: 3.0, y: 2.0 });
    assert!(!geometry.is_open(left, right) && !geometry.is_open(right, left));
}

#[test]
fn overlapping_discs_are_distinguished() {
    let disc = |x, y, radius_m| Disc {
        centre: Point { x, y },
        radius_m,
    };
    let discs = [
        disc(8.0, 2.0, 1.0),
        disc(2.0, 2.0, 1.0),
        disc(5.0, 8.0, 1.0),
        disc(3.5, 2.5, 0.75),
        disc(2.0, 7.0, 0.5),
        disc(2.1, 7.0, 0.1),
    ];
    let geometry = StaticGeometry::new(Point { x: 10.0, y: 10.0 }, &[], &discs, 1.0);
    let found = |place: Point| {
        geometry.discs_within(place, 1.0).map(|numbers| {
            numbers
                .map(|(number, _)| geometry.disc(number).centre.x)
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(found(Point { x: 8.0, y: 2.0 }), [vec![8.0], vec![]]);
    assert_eq!(found(Point { x: 5.0, y: 8.0 }), [vec![5.0], vec![]]);
    assert_eq!(found(Point { x: 3.0, y: 2.0 }), [vec![], vec![2.0, 3.5]]);
    assert_eq!(found(Point { x: 2.0, y: 7.0 }), [vec![], vec![2.0, 2.1]]);
}

#[test]
fn a_full_view_sees_every_place() {
    let mut clear = 0;
    for number in 0..2000 {
        let mut random = random(number);
        let scene = Scene::new(&mut random);
        let scene = Scene {
            walls: scene.walls[..7].to_vec(),
            ..scene
        };
        let geometry = scene.geometry(0.0);
        let mut share = || unit(&mut random);
        let from = Point {
            x: scene.size.x * share(),
            y: scene.size.y * share(),
        };
        let reach_m = 0.2 * scene.size.x * share();
        let bearing_rad = std::f64::consts::TAU * share();
        let (y, x) = bearing_rad.sin_cos();
        let to = from.plus(Point { x, y }.times(0.999 * reach_m));
        if geometry.is_clear(from, reach_m) {
            clear += 1;
            assert!(geometry.is_open(from, to), "{number}");
        }
    }
    assert!((200..1900).contains(&clear), "{clear}");
}

#[test]
fn on_a_torus_what_is_around_a_place_tells_which_ways_from_it_are_open() {
    let (mut open, mut shut) = (0, 0);
    for number in 0..40 {
        let mut random = random(number);
        let scene = Scene::new(&mut random);
        let torus = Torus { size_m: scene.size };
        // Without the border, which a periodic world does not have.
        let walls: Vec<Wall> = scene.walls[4..].iter().filter_map(Wall::of).collect();
        let geometry = StaticGeometry::on(torus, &walls, &scene.discs, 0.1);
        for _ in 0..50 {
            let mut share = || unit(&mut random);
            let from = Point {
                x: share() * scene.size.x,
                y: share() * scene.size.y,
            };
            let way = Point {
                x: share() - 0.5,
                y: share() - 0.5,
            }
            .times(0.9 * scene.size.y.min(scene.size.x));
            let to = from.plus(way);
            let is_visible = geometry.around(from, way.length()).open_share(to) >= 1.0;
            assert_eq!(
                is_visible,
                geometry.is_open(from, to),
                "{number}: {from:?} {to:?}"
            );
            open += u32::from(is_visible);
            shut += u32::from(!is_visible);
        }
    }
    assert!(open > 300 && shut > 300, "{open} {shut}");
}
