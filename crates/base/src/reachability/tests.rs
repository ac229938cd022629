use super::*;
use crate::geometry::Segment;
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn point(x: f64, y: f64) -> Point {
    Point { x, y }
}

fn square(side_m: f64) -> Rectangle {
    Rectangle::spanned(point(0.0, 0.0), point(side_m, side_m))
}

fn here(x: f64, y: f64) -> Rectangle {
    Rectangle::spanned(point(x, y), point(x, y))
}

fn wall(from: [f64; 2], to: [f64; 2]) -> Solid {
    Solid::Wall(Segment {
        from: from.into(),
        to: to.into(),
    })
}

fn pillar(x: f64, y: f64, radius_m: f64) -> Solid {
    Solid::Pillar(Disc {
        centre: point(x, y),
        radius_m,
    })
}

/// Whether a robot of radius 0.5 may come from the left of a wall with a gap to its right; `turn`
/// mirrors the room.
fn may_pass(gap_m: f64, turn: fn(f64, f64) -> [f64; 2]) -> bool {
    let walls = [
        wall(turn(5.0, 0.0), turn(5.2, 4.0)),
        wall(turn(5.2, 4.0 + gap_m), turn(5.0, 10.0)),
    ];
    let reach = Reachability::new(
        square(10.0),
        0.5,
        walls,
        &[here(turn(2.0, 2.0)[0], turn(2.0, 2.0)[1])],
    );
    reach.may_come_near(turn(8.0, 8.0).into(), 0.0)
}

#[test]
fn a_wall_without_a_gap_keeps_a_robot_on_its_side() {
    let divided = [wall([5.0, -1.0], [6.0, 11.0])];
    let reach = Reachability::new(square(10.0), 0.5, divided, &[here(2.0, 2.0)]);
    assert!(reach.may_come_near(point(1.0, 9.0), 0.0));
    assert!(!reach.may_come_near(point(8.0, 8.0), 0.0));
    // Close to the wall it comes near what is behind it.
    assert!(reach.may_come_near(point(6.0, 5.0), 1.2));
    assert!(!reach.may_come_near(point(8.0, 5.0), 1.2));
}

#[test]
fn a_gap_lets_through_what_fits_and_nothing_much_larger() {
    for turn in [
        |x, y| [x, y],
        |x, y| [y, x],
        |x, y| [10.0 - x, y],
        |x, y| [y, 10.0 - x],
    ] {
        assert!(may_pass(1.0 + 1e-6, turn));
        assert!(!may_pass(0.8, turn));
    }
}

#[test]
fn a_ring_of_pillars_is_a_wall_if_the_robot_does_not_fit_between_them() {
    let ring = |count: u32| {
        let turn = std::f64::consts::TAU / f64::from(count);
        let pillars = (0..count).map(|at| {
            let (sine, cosine) = crate::trig::sin_cos(turn * f64::from(at));
            pillar(5.0 + 3.0 * cosine, 5.0 + 3.0 * sine, 0.3)
        });
        let reach = Reachability::new(
            square(10.0),
            0.4,
            pillars.collect::<Vec<_>>(),
            &[here(0.5, 0.5)],
        );
        reach.may_come_near(point(5.0, 5.0), 0.0)
    };
    // 12 pillars are 0.95 metres apart, 20 are 0.34.
    assert!(ring(12));
    assert!(!ring(20));
}

#[test]
fn what_lies_beyond_the_world_is_never_come_to() {
    let reach = Reachability::new(square(10.0), 0.5, [], &[square(10.0)]);
    assert!(reach.may_come_near(point(5.0, 5.0), 0.0));
    assert!(!reach.may_come_near(point(0.2, 5.0), 0.0));
    assert!(reach.may_come_near(point(0.2, 5.0), 0.3));
    assert!(!reach.may_come_near(point(12.0, 5.0), 1.0));
    let nowhere = Reachability::new(square(10.0), 0.5, [], &[]);
    assert!(!nowhere.may_come_near(point(5.0, 5.0), 100.0));
}

#[test]
fn a_start_anywhere_is_a_start_in_every_room() {
    let divided = [wall([5.0, 0.0], [5.0, 10.0])];
    let reach = Reachability::new(square(10.0), 0.5, divided, &[square(10.0)]);
    assert!(reach.may_come_near(point(2.0, 2.0), 0.0));
    assert!(reach.may_come_near(point(8.0, 8.0), 0.0));
}

#[test]
fn a_world_too_large_for_fine_cells_is_never_called_unreachable_in_vain() {
    let divided = [wall([5e4, 0.0], [5e4, 1e5])];
    let reach = Reachability::new(square(1e5), 0.1, divided, &[here(1.0, 1.0)]);
    assert!(reach.may_come_near(point(9e4, 9e4), 0.0));
    assert!(reach.cells.count() <= MAX_CELLS as usize);
    let narrow = Rectangle::spanned(point(0.0, 0.0), point(1e9, 1e-3));
    assert!(Cells::new(narrow, 1e-3).count() <= MAX_CELLS as usize);
}

#[test]
fn ten_thousand_walls_and_four_million_cells_take_seconds() {
    let walls = (0..10_000_u32).map(|at| {
        let along = f64::from(at) / 10.0;
        wall([along, 0.0], [1000.0 - along, 900.0])
    });
    let start = Instant::now();
    let reach = Reachability::new(square(1000.0), 2.0, walls, &[square(1000.0)]);
    assert!(reach.may_come_near(point(500.0, 950.0), 0.0));
    assert!(
        start.elapsed() < Duration::from_secs(20),
        "{:?}",
        start.elapsed()
    );
}

#[test]
fn parts_are_the_same_exactly_where_a_way_connects_places() {
    let divided = [wall([5.0, -1.0], [6.0, 11.0])];
    let reach = Reachability::new(square(10.0), 0.5, divided, &[here(2.0, 2.0)]);
    let part_at = |x, y| {
        let parts: Vec<u32> = reach.parts_near(point(x, y), 0.0).collect();
        assert!(!parts.is_empty() && parts.iter().all(|part| *part == parts[0]));
        parts[0]
    };
    assert_eq!(reach.parts(), 2);
    assert_eq!(part_at(2.0, 2.0), part_at(1.0, 9.0));
    assert_ne!(part_at(2.0, 2.0), part_at(8.0, 8.0));
    assert!(reach.is_reached(part_at(1.0, 9.0)) && !reach.is_reached(part_at(8.0, 8.0)));
    for part in [0, 1] {
        let place = reach.place_in(part).unwrap();
        assert_eq!(part_at(place.x, place.y), part);
    }
    assert!(reach.place_in(2).is_none() && !reach.is_reached(2));
    // At the wall, both sides are near.
    assert!(
        reach
            .parts_near(point(5.5, 5.0), 1.0)
            .any(|part| part == part_at(8.0, 8.0))
    );
}

#[test]
fn at_the_smallest_radius_walls_of_any_direction_have_no_gaps() {
    let world = square(3000.0);
    let radius_m = Reachability::min_radius_m(world);
    for at in 0..10 {
        let tilt = 150.0 * f64::from(at);
        let divided = [wall([tilt, -1.0], [3000.0 - tilt, 3001.0])];
        let start = here(3000.0 - tilt.max(10.0), 10.0);
        let other = point(tilt.max(10.0), 2990.0);
        let reach = Reachability::new(world, radius_m, divided, &[start]);
        assert!(!reach.may_come_near(other, 0.0), "{tilt}");
    }
}

fn distance_m(solid: &Solid, at: Point) -> f64 {
    match solid {
        Solid::Wall(wall) => wall.distance_m(at),
        Solid::Pillar(disc) => disc.distance_m(at),
    }
}

fn solids() -> impl Strategy<Value = Vec<Solid>> {
    let end = || (0.0..6.0, 0.0..6.0).prop_map(|(x, y)| [x, y]);
    let one = prop_oneof![
        (end(), end()).prop_map(|(from, to)| wall(from, to)),
        (end(), 0.01..0.8).prop_map(|([x, y], radius_m)| pillar(x, y, radius_m)),
    ];
    prop::collection::vec(one, 0..12)
}

proptest! {
    #[test]
    fn where_a_robot_walks_it_may_come(
        solids in solids(), radius_m in 0.1_f64..0.5, seed: u64,
        start in (0.0..6.0, 0.0..6.0),
    ) {
        let world = square(6.0);
        let mut stream = crate::random::Stream::from_u64_seed(seed);
        let mut at = point(start.0, start.1);
        let walls = world.room().map(Solid::Wall);
        let is_free = |at: Point| {
            world.contains(at)
                && solids.iter().chain(&walls).all(|solid| distance_m(solid, at) >= radius_m)
        };
        prop_assume!(is_free(at));
        let reach = Reachability::new(world, radius_m, solids.iter().copied(), &[here(at.x, at.y)]);
        for _ in 0..2000 {
            // Shorter than anything between two places could be thick.
            let step = point(0.1 * crate::random::unit(&mut stream) - 0.05, 0.1 * crate::random::unit(&mut stream) - 0.05);
            if is_free(at.plus(step)) {
                at = at.plus(step);
            }
            prop_assert!(reach.may_come_near(at, 0.0), "{at:?}");
        }
    }

    #[test]
    fn cells_near_a_solid_are_those_whose_middle_is(
        solids in solids(), radius_m in 0.1_f64..0.5, near_m in 0.0_f64..1.0,
    ) {
        let world = square(6.0);
        let cells = Cells::new(world, radius_m);
        let side_m = radius_m / 4.0;
        for solid in &solids {
            let mut is_near = vec![false; cells.count()];
            for run in cells.near(*solid, near_m) {
                is_near[cells.indices(&run)].fill(true);
            }
            let columns = (6.0 / side_m).ceil();
            for (index, is_near) in is_near.into_iter().enumerate() {
                let index = f64::from(u32::try_from(index).unwrap());
                let (row, column) = ((index / columns).floor(), index % columns);
                let middle = point((column + 0.5) * side_m, (row + 0.5) * side_m);
                let distance_m = distance_m(solid, middle);
                // Rounding decides where the two are the same.
                if (distance_m - near_m).abs() > 1e-9 {
                    prop_assert_eq!(is_near, distance_m < near_m, "{:?} {:?}", solid, middle);
                }
            }
        }
    }
}
