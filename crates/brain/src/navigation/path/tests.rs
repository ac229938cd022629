use super::*;
use crate::perception::beliefs::occupancy::Ray;
use base::geometry::{Rectangle, Segment};
use proptest::prelude::*;

const COLUMNS: usize = 14;
const ROWS: usize = 11;

const CELL_M: f64 = 0.5;

fn field() -> Field {
    let corner = Point { x: 7.0, y: 5.5 };
    Field::new(&Rectangle::spanned(Point::default(), corner), CELL_M, 1000)
}

fn map(is_occupied: impl Fn(usize, usize) -> bool) -> Occupancy {
    let field = field();
    let mut map = Occupancy::new(&field);
    for cell in (0..field.cells()).filter(|cell| is_occupied(cell % COLUMNS, cell / COLUMNS)) {
        let centre = field.centre(cell);
        let free = Segment {
            from: centre,
            to: centre,
        };
        map.add_ray(
            &field,
            &Ray {
                free,
                hit: Some(free.to),
            },
        );
    }
    map
}

/// A map from a drawing, the highest row first.
fn drawn(rows: [&str; ROWS]) -> Occupancy {
    map(|column, row| rows[ROWS - 1 - row].as_bytes()[column] == b'#')
}

fn point(column: usize, row: usize) -> Point {
    field().centre(row * COLUMNS + column)
}

fn wavefront(map: &Occupancy, origin: Point, radius_m: f64) -> Wavefront {
    let mut wavefront = Wavefront::default();
    wavefront.expand((&field(), map), origin, radius_m, |_, _| true);
    wavefront
}

/// Whether a body of this radius fits into each cell.
fn open_cells(map: &Occupancy, radius_m: f64) -> Vec<bool> {
    let field = field();
    let is_near =
        |cell: usize, other: usize| field.centre(cell).to(field.centre(other)).length() <= radius_m;
    let fits = |cell| {
        !map.occupied()
            .any(|other| other == cell || is_near(cell, other))
    };
    (0..field.cells()).map(fits).collect()
}

/// Reference: relaxes all steps until no distance changes.
fn distances(is_open: &[bool], from: usize) -> Vec<Option<u16>> {
    let mut costs = vec![UNREACHED; is_open.len()];
    costs[from] = 0;
    let mut is_changing = true;
    while is_changing {
        is_changing = false;
        for (cell, next, step) in steps(is_open) {
            let cost = costs[cell].saturating_add(step);
            if cost < costs[next] {
                costs[next] = cost;
                is_changing = true;
            }
        }
    }
    let costs = costs.into_iter();
    costs
        .map(|cost| (cost < UNREACHED).then_some(cost))
        .collect()
}

/// All steps between open cells, but no diagonal ones between two blocked cells.
fn steps(is_open: &[bool]) -> Vec<(usize, usize, u16)> {
    let open = |column: usize, row: usize| is_open[row * COLUMNS + column];
    let mut steps = Vec::new();
    for cell in (0..is_open.len()).filter(|cell| is_open[*cell]) {
        let (column, row) = (cell % COLUMNS, cell / COLUMNS);
        for next in (0..is_open.len()).filter(|next| is_open[*next]) {
            let (right, up) = (next % COLUMNS, next / COLUMNS);
            let (dx, dy) = (column.abs_diff(right), row.abs_diff(up));
            let is_gap = dx == 1 && dy == 1 && !open(right, row) && !open(column, up);
            if dx.max(dy) == 1 && !is_gap {
                steps.push((cell, next, if dx + dy == 2 { 7 } else { 5 }));
            }
        }
    }
    steps
}

/// The cells on the path from one to the origin.
fn cells_to_origin(wavefront: &Wavefront, from: usize) -> Vec<usize> {
    core::iter::successors(Some(from), |cell| wavefront.next(&field(), *cell)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn distances_match_the_reference(
        filled in proptest::collection::vec(0_u8..4, COLUMNS * ROWS),
        few in 1_u8..3, from in 0..COLUMNS * ROWS,
        radius_m in prop_oneof![Just(0.1), Just(0.6), Just(0.8)],
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] < few && row % few as usize == 0);
        let (field, is_open) = (field(), open_cells(&map, radius_m));
        prop_assume!(is_open[from]);
        let wavefront = wavefront(&map, field.centre(from), radius_m);
        for (cell, expected) in distances(&is_open, from).into_iter().enumerate() {
            let expected_m = expected.map(|cost| f64::from(cost) / 5.0 * CELL_M);
            prop_assert_eq!(wavefront.cell_distance_m(&field, cell), expected_m, "{}", cell);
            prop_assert_eq!(wavefront.is_blocked(&field, cell), !is_open[cell]);
        }
    }

    #[test]
    fn every_path_leads_over_open_cells_to_the_origin(
        filled in proptest::collection::vec(0_u8..6, COLUMNS * ROWS), from in 0..COLUMNS * ROWS,
        radius_m in prop_oneof![Just(0.1), Just(0.6)],
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, is_open) = (field(), open_cells(&map, radius_m));
        let wavefront = wavefront(&map, field.centre(from), radius_m);
        for cell in (0..field.cells()).filter(|cell| is_open[*cell]) {
            if wavefront.cell_distance_m(&field, cell).is_none() {
                continue;
            }
            let path = cells_to_origin(&wavefront, cell);
            prop_assert!(path.iter().all(|cell| is_open[*cell]));
            let last = field.centre(*path.last().unwrap());
            prop_assert!(!is_open[from] || last == field.centre(from));
            prop_assert!(map.is_visible(&field, last, field.centre(from), 0.0));
            prop_assert_eq!(wavefront.waypoint(&field, &map, last), Some(field.centre(from)));
        }
    }

    #[test]
    fn a_robot_too_near_to_an_obstacle_leaves_along_a_free_line(
        filled in proptest::collection::vec(0_u8..6, COLUMNS * ROWS), from in 0..COLUMNS * ROWS,
        at in 0..COLUMNS * ROWS,
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, wavefront) = (field(), wavefront(&map, field().centre(from), 0.6));
        prop_assume!(wavefront.is_blocked(&field, at));
        let at = field.centre(at);
        if let Some((exit, path_m)) = wavefront.exit(&field, &map, at) {
            prop_assert!(map.is_visible(&field, field.centre(exit), at, 0.0));
            prop_assert!(path_m > wavefront.cell_distance_m(&field, exit).unwrap());
            prop_assert_eq!(wavefront.waypoint(&field, &map, at), Some(field.centre(exit)));
        }
    }

    #[test]
    fn the_waypoint_can_be_reached_in_a_straight_line(
        filled in proptest::collection::vec(0_u8..8, COLUMNS * ROWS),
        from in 0..COLUMNS * ROWS, at in (0.0_f64..7.0, 0.0_f64..5.5),
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, at) = (field(), Point { x: at.0, y: at.1 });
        let wavefront = wavefront(&map, field.centre(from), 0.1);
        let here = field.nearest_cell(at);
        if let Some(here_m) = wavefront.cell_distance_m(&field, here) {
            let waypoint = wavefront.waypoint(&field, &map, at).unwrap();
            let next = wavefront.next(&field, here).map(|cell| field.centre(cell));
            let is_next = Some(waypoint) == next || waypoint == field.centre(from);
            prop_assert!(is_next || wavefront.is_open_between(&field, at, waypoint));
            let left_m = wavefront.cell_distance_m(&field, field.nearest_cell(waypoint));
            prop_assert!(left_m.is_none_or(|left_m| left_m < here_m || here_m == 0.0));
        }
    }
}

const WALL: [&str; ROWS] = [
    "..............",
    "..............",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
    "......#.......",
];

#[test]
fn a_path_leads_around_a_wall() {
    let map = drawn(WALL);
    let wavefront = wavefront(&map, point(12, 1), 0.4);
    let mut at = point(1, 1);
    let mut highest_m = 0.0_f64;
    for _ in 0..20 {
        at = wavefront.waypoint(&field(), &map, at).unwrap();
        highest_m = highest_m.max(at.y);
    }
    assert_eq!(at, point(12, 1));
    assert!(highest_m > 4.5, "{highest_m}");
}

#[test]
fn a_goal_close_behind_a_wall_is_reached_around_it() {
    for radius_m in [0.1, 0.6] {
        let map = drawn(WALL);
        let wavefront = wavefront(&map, point(7, 3), radius_m);
        let here = field().nearest_cell(point(5, 3));
        let exit_m = || {
            wavefront
                .exit(&field(), &map, point(5, 3))
                .map(|(_, path_m)| path_m)
        };
        let path_m = wavefront
            .cell_distance_m(&field(), here)
            .or_else(exit_m)
            .unwrap();
        assert!(path_m > 6.0, "{path_m}");
    }
}

#[test]
fn a_robot_close_to_a_wall_moves_away_from_it() {
    let map = drawn(WALL);
    let wavefront = wavefront(&map, point(1, 9), 0.6);
    let close = point(5, 3);
    assert!(wavefront.is_blocked(&field(), field().nearest_cell(close)));
    assert!(wavefront.waypoint(&field(), &map, close).unwrap().x < close.x);
}

const GAP_AND_DOOR: [&str; ROWS] = [
    "..............",
    "..............",
    "..............",
    "######........",
    "......#.......",
    "......#.......",
    "......#.......",
    "..............",
    "......#.......",
    "......#.......",
    "......#.......",
];

#[test]
fn no_path_leads_through_a_gap_that_is_too_narrow() {
    let map = drawn(GAP_AND_DOOR);
    let outside = point(10, 3);
    let inside = field().nearest_cell(point(2, 3));
    let narrow = wavefront(&map, outside, 0.1);
    let wide = wavefront(&map, outside, 0.6);
    assert_eq!(narrow.cell_distance_m(&field(), inside), Some(4.0));
    assert_eq!(wide.cell_distance_m(&field(), inside), None);
}

#[test]
fn the_wide_door_is_used_instead_of_a_narrow_gap_nearby() {
    let mut rows = GAP_AND_DOOR;
    rows[3] = "..............";
    let map = drawn(rows);
    // The robot and its goal are on opposite sides of the gap.
    let wavefront = wavefront(&map, point(8, 3), 0.6);
    let path = cells_to_origin(&wavefront, field().nearest_cell(point(4, 3)));
    let gap = field().nearest_cell(point(6, 3));
    assert!(path.len() > 8 && !path.contains(&gap), "{path:?}");
}

#[test]
fn a_diagonal_wall_has_no_gaps() {
    let map = map(|column, row| column == row);
    for (radius_m, goal) in [(0.1, [8, 2]), (0.6, [8, 2]), (0.6, [8, 7]), (0.1, [8, 7])] {
        let wavefront = wavefront(&map, point(goal[0], goal[1]), radius_m);
        let beyond = field().nearest_cell(point(2, 8));
        assert_eq!(
            wavefront.cell_distance_m(&field(), beyond),
            None,
            "{radius_m}"
        );
    }
}

/// The distances of the cells from an origin if paths lead through stale obstacles.
fn through_stale(map: &Occupancy, origin: Point) -> Wavefront {
    let mut wavefront = Wavefront::default();
    wavefront.pass_stale(true);
    wavefront.expand((&field(), map), origin, 0.1, |_, _| true);
    wavefront
}

/// Observes that a cell is occupied.
fn observe(map: &mut Occupancy, at: Point) {
    let free = Segment { from: at, to: at };
    let hit = Some(at);
    map.add_ray(&field(), &Ray { free, hit });
}

#[test]
fn a_path_leads_through_a_stale_wall_at_an_extra_cost_until_all_of_it_is_observed() {
    let mut map = map(|column, _| column == 6);
    let (start, goal) = (point(2, 5), point(10, 5));
    let here = field().nearest_cell(start);
    let distance_m = |map: &Occupancy| through_stale(map, goal).cell_distance_m(&field(), here);
    assert_eq!(distance_m(&map), None);
    map.mark_stale();
    assert_eq!(distance_m(&map), Some(4.0 + 10.0));
    let distances = (0..ROWS).map(|row| {
        // From the middle outwards.
        let row = if row % 2 == 0 {
            5 - row / 2
        } else {
            6 + row / 2
        };
        observe(&mut map, point(6, row));
        distance_m(&map)
    });
    let distances: Vec<Option<f64>> = distances.collect();
    assert!(distances.is_sorted_by(|one, other| other.is_none() || one <= other));
    assert_eq!(distances.iter().filter(|each| each.is_none()).count(), 1);
    assert_eq!(
        wavefront(&map, goal, 0.1).cell_distance_m(&field(), here),
        None
    );
}

#[test]
fn a_path_leads_around_a_stale_wall_if_that_costs_less() {
    let mut map = drawn(WALL);
    let here = field().nearest_cell(point(1, 1));
    let around_m = wavefront(&map, point(12, 1), 0.1).cell_distance_m(&field(), here);
    map.mark_stale();
    let wavefront = through_stale(&map, point(12, 1));
    assert_eq!(wavefront.cell_distance_m(&field(), here), around_m);
    let mut at = point(1, 1);
    for _ in 0..20 {
        let next = wavefront.waypoint(&field(), &map, at).unwrap();
        assert!(map.is_free_between(&field(), at, next), "{at:?} {next:?}");
        at = next;
    }
    assert_eq!(at, point(12, 1));
}
