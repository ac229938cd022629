use super::*;
use crate::world::static_geometry::Wall;
use base::geometry::{Disc, Segment};
use base::random::{Entity, Purpose, Stream, stream, unit};

fn random(scene: u64) -> Stream {
    stream(9, scene, Entity { kind: 0, index: 0 }, Purpose::Item)
}

/// Worlds of all sizes and shapes, each with cells of a size.
fn worlds() -> [(Point, f64); 6] {
    let size = |x, y| Point { x, y };
    [
        (size(10.0, 20.0), 1.5),
        (size(0.1, 0.1), 0.25),
        (size(0.1, 100_000.0), 0.25),
        (size(100_000.0, 100_000.0), 0.25),
        (size(25.0, 25.0), 0.5),
        (size(7.0, 3.0), 100.0),
    ]
}

/// Places in and about a world: anywhere, on borders of cells, on the world's border, and outside.
fn place(random: &mut Stream, grid: &Grid, size: Point) -> Point {
    let anywhere = Point {
        x: size.x * (1.4 * unit(random) - 0.2),
        y: size.y * (1.4 * unit(random) - 0.2),
    };
    let on_line = |value: f64| (value / grid.cell_m()).round() * grid.cell_m();
    match random.bounded(6) {
        0 => Point {
            x: on_line(anywhere.x),
            ..anywhere
        },
        1 => Point {
            x: on_line(anywhere.x),
            y: on_line(anywhere.y),
        },
        2 => Point { x: 0.0, ..anywhere },
        3 => Point {
            y: size.y,
            ..anywhere
        },
        _ => anywhere,
    }
}

fn inside(point: Point, size: Point) -> Point {
    Point {
        x: point.x.max(0.0).min(size.x),
        y: point.y.max(0.0).min(size.y),
    }
}

#[test]
fn a_way_goes_through_the_cells_of_all_its_points() {
    for (size, cell_m) in worlds() {
        let grid = Grid::new(size, cell_m);
        for number in 0..300 {
            let mut random = random(number);
            let from = place(&mut random, &grid, size);
            let mut to = place(&mut random, &grid, size);
            match random.bounded(5) {
                0 => to.x = from.x,
                1 => to.y = from.y,
                2 => to = from.plus(Point { x: to.x, y: to.x }),
                3 => to = from,
                _ => {}
            }
            // A column or a row of millions of cells takes its time.
            let cells: Vec<usize> = grid.cells_along(from, to).take(200_000).collect();
            if cells.len() == 200_000 {
                continue;
            }
            assert!(cells.windows(2).all(|pair| pair[0] < pair[1]), "each once");
            for step in 0..=1000 {
                let point = from.plus(from.to(to).times(f64::from(step) / 1000.0));
                let cell = grid.cell(point);
                assert!(
                    cells.binary_search(&cell).is_ok(),
                    "{size:?} {from:?} {to:?} {point:?}"
                );
            }
        }
    }
}

#[test]
fn a_way_goes_through_few_cells_beside_it() {
    let grid = Grid::new(Point { x: 100.0, y: 100.0 }, 1.0);
    let count = |from: [f64; 2], to: [f64; 2]| grid.cells_along(from.into(), to.into()).count();
    assert_eq!(count([0.5, 0.5], [99.5, 0.5]), 100);
    assert_eq!(count([0.5, 0.5], [0.5, 99.5]), 100);
    // Diagonally through the corners, and a hair beside them.
    assert!(count([0.5, 0.5], [99.5, 99.5]) <= 300);
    assert!(count([0.5, 0.5], [99.5, 49.5]) <= 200);
    assert_eq!(count([0.5, 0.5], [0.6, 0.6]), 1);
}

#[test]
fn cells_cover_the_world_and_are_not_too_many() {
    for (size, cell_m) in worlds() {
        let grid = Grid::new(size, cell_m);
        assert!(grid.cells() <= 4_100_000, "{size:?}: {}", grid.cells());
        assert!(grid.cell_m() >= cell_m * 0.999_999);
        for corner in [Point::default(), size, Point { x: size.x, y: 0.0 }] {
            let middle = grid.middle(grid.cell(corner));
            let way = middle.to(corner);
            let half = grid.cell_m() * 0.500_001;
            assert!(
                way.x.abs() <= half && way.y.abs() <= half,
                "{size:?} {corner:?} {middle:?}"
            );
        }
    }
}

fn wall(random: &mut Stream, grid: &Grid, size: Point) -> Option<Wall> {
    Wall::of(&Segment {
        from: place(random, grid, size),
        to: place(random, grid, size),
    })
}

#[test]
fn everything_within_reach_of_a_place_is_in_its_cells_list() {
    for (size, _) in worlds()
        .into_iter()
        .filter(|(size, _)| size.x * size.y < 1e6)
    {
        for reach_m in [0.0, 0.3, 2.0, 50.0_f64] {
            let grid = Grid::new(size, reach_m.max(0.1));
            let mut random = random(17);
            let walls: Vec<Wall> = (0..40)
                .filter_map(|_| wall(&mut random, &grid, size))
                .collect();
            let discs: Vec<Disc> = (0..40)
                .map(|_| Disc {
                    centre: place(&mut random, &grid, size),
                    radius_m: 0.2 * size.x.min(size.y) * unit(&mut random),
                })
                .collect();
            let (near_walls, near_discs) = (
                NearCells::new(size, &walls, reach_m),
                NearCells::new(size, &discs, reach_m),
            );
            for _ in 0..400 {
                let point = inside(place(&mut random, near_walls.grid(), size), size);
                for (number, wall) in (0..).zip(&walls) {
                    let is_listed = near_walls.at(point).contains(&number);
                    assert!(
                        is_listed || wall.distance(point) > reach_m,
                        "{size:?} {point:?} {wall:?}"
                    );
                }
                for (number, disc) in (0..).zip(&discs) {
                    let is_listed = near_discs.at(point).contains(&number);
                    assert!(
                        is_listed || disc.distance(point) > reach_m,
                        "{size:?} {point:?} {disc:?}"
                    );
                }
                assert!(
                    near_walls
                        .at(point)
                        .windows(2)
                        .all(|pair| pair[0] < pair[1])
                );
            }
        }
    }
}

#[test]
fn lists_leave_out_what_is_far() {
    let size = Point { x: 100.0, y: 100.0 };
    let discs: Vec<Disc> = (0..100)
        .map(|number| Disc {
            centre: Point {
                x: f64::from(number % 10) * 10.0 + 5.0,
                y: f64::from(number / 10) * 10.0 + 5.0,
            },
            radius_m: 0.5,
        })
        .collect();
    let near = NearCells::new(size, &discs, 1.0);
    assert_eq!(near.at([5.0, 5.0].into()), [0]);
    assert_eq!(near.at([10.0, 10.0].into()).len(), 0);
    assert_eq!(near.at([99.0, 95.0].into()).len(), 0);
}
