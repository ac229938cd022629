use super::*;
use crate::perception::beliefs::occupancy::Ray;
use base::geometry::{Rectangle, Segment};
use proptest::prelude::*;

const COLUMNS: usize = 14;
const ROWS: usize = 11;

/// Cells are this wide, in metres.
const CELL_M: f64 = 0.5;

fn field() -> Field {
    let corner = Point { x: 7.0, y: 5.5 };
    Field::new(&Rectangle::spanned(Point::default(), corner), CELL_M, 1000)
}

fn map(is_filled: impl Fn(usize, usize) -> bool) -> Occupancy {
    let field = field();
    let mut map = Occupancy::new(&field);
    for cell in (0..field.cells()).filter(|cell| is_filled(cell % COLUMNS, cell / COLUMNS)) {
        let centre = field.centre(cell);
        let way = Segment {
            from: centre,
            to: centre,
        };
        map.take_in(
            &field,
            &Ray {
                way,
                hit: Some(way.to),
            },
        );
    }
    map
}

/// A map as one draws it, the highest row first.
fn drawn(rows: [&str; ROWS]) -> Occupancy {
    map(|column, row| rows[ROWS - 1 - row].as_bytes()[column] == b'#')
}

fn place(column: usize, row: usize) -> Point {
    field().centre(row * COLUMNS + column)
}

fn wave(map: &Occupancy, from: Point, radius_m: f64) -> Wave {
    let mut wave = Wave::default();
    wave.run((&field(), map), from, radius_m, |_, _| true);
    wave
}

/// Whether a body of this radius fits into each cell.
fn opens(map: &Occupancy, radius_m: f64) -> Vec<bool> {
    let field = field();
    let is_near =
        |cell: usize, other: usize| field.centre(cell).to(field.centre(other)).length() <= radius_m;
    let is_open = |cell| {
        !map.filled()
            .any(|other| other == cell || is_near(cell, other))
    };
    (0..field.cells()).map(is_open).collect()
}

/// The plainest way to find all distances: until nothing changes.
fn distances(opens: &[bool], from: usize) -> Vec<Option<u16>> {
    let mut all = vec![NEVER; opens.len()];
    all[from] = 0;
    let mut is_changing = true;
    while is_changing {
        is_changing = false;
        for (cell, next, step) in steps(opens) {
            let fifths = all[cell].saturating_add(step);
            if fifths < all[next] {
                all[next] = fifths;
                is_changing = true;
            }
        }
    }
    let reached = all.into_iter();
    reached
        .map(|fifths| (fifths < NEVER).then_some(fifths))
        .collect()
}

/// All steps that can be taken: from open to open cells, and none aslant between two shut ones.
fn steps(opens: &[bool]) -> Vec<(usize, usize, u16)> {
    let open = |column: usize, row: usize| opens[row * COLUMNS + column];
    let mut steps = Vec::new();
    for cell in (0..opens.len()).filter(|cell| opens[*cell]) {
        let (column, row) = (cell % COLUMNS, cell / COLUMNS);
        for next in (0..opens.len()).filter(|next| opens[*next]) {
            let (right, up) = (next % COLUMNS, next / COLUMNS);
            let (dx, dy) = (column.abs_diff(right), row.abs_diff(up));
            let is_crack = dx == 1 && dy == 1 && !open(right, row) && !open(column, up);
            if dx.max(dy) == 1 && !is_crack {
                steps.push((cell, next, if dx + dy == 2 { 7 } else { 5 }));
            }
        }
    }
    steps
}

/// The cells on the way from one down to where the wave began.
fn way_down(wave: &Wave, from: usize) -> Vec<usize> {
    core::iter::successors(Some(from), |cell| wave.next(&field(), *cell)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn distances_are_those_of_the_plainest_search(
        filled in proptest::collection::vec(0_u8..4, COLUMNS * ROWS),
        few in 1_u8..3, from in 0..COLUMNS * ROWS,
        radius_m in prop_oneof![Just(0.1), Just(0.6), Just(0.8)],
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] < few && row % few as usize == 0);
        let (field, opens) = (field(), opens(&map, radius_m));
        prop_assume!(opens[from]);
        let wave = wave(&map, field.centre(from), radius_m);
        for (cell, expected) in distances(&opens, from).into_iter().enumerate() {
            let expected_m = expected.map(|fifths| f64::from(fifths) / 5.0 * CELL_M);
            prop_assert_eq!(wave.cell_distance_m(&field, cell), expected_m, "{}", cell);
            prop_assert_eq!(wave.is_shut(&field, cell), !opens[cell]);
        }
    }

    #[test]
    fn a_way_leads_straight_on_to_where_the_wave_began_over_open_cells(
        filled in proptest::collection::vec(0_u8..6, COLUMNS * ROWS), from in 0..COLUMNS * ROWS,
        radius_m in prop_oneof![Just(0.1), Just(0.6)],
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, opens) = (field(), opens(&map, radius_m));
        let wave = wave(&map, field.centre(from), radius_m);
        for cell in (0..field.cells()).filter(|cell| opens[*cell]) {
            if wave.cell_distance_m(&field, cell).is_none() {
                continue;
            }
            let way = way_down(&wave, cell);
            prop_assert!(way.iter().all(|cell| opens[*cell]));
            let last = field.centre(*way.last().unwrap());
            prop_assert!(!opens[from] || last == field.centre(from));
            prop_assert!(map.sees(&field, last, field.centre(from), 0.0));
            prop_assert_eq!(wave.ahead(&field, &map, last), Some(field.centre(from)));
        }
    }

    #[test]
    fn who_stands_too_near_to_something_gets_out_by_a_way_that_is_free(
        filled in proptest::collection::vec(0_u8..6, COLUMNS * ROWS), from in 0..COLUMNS * ROWS,
        at in 0..COLUMNS * ROWS,
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, wave) = (field(), wave(&map, field().centre(from), 0.6));
        prop_assume!(wave.is_shut(&field, at));
        let place = field.centre(at);
        if let Some((out, way_m)) = wave.out_of(&field, &map, place) {
            prop_assert!(map.sees(&field, field.centre(out), place, 0.0));
            prop_assert!(way_m > wave.cell_distance_m(&field, out).unwrap());
            prop_assert_eq!(wave.ahead(&field, &map, place), Some(field.centre(out)));
        }
    }

    #[test]
    fn straight_ahead_lies_what_can_be_gone_to_straight(
        filled in proptest::collection::vec(0_u8..8, COLUMNS * ROWS),
        from in 0..COLUMNS * ROWS, at in (0.0_f64..7.0, 0.0_f64..5.5),
    ) {
        let map = map(|column, row| filled[row * COLUMNS + column] == 0);
        let (field, at) = (field(), Point { x: at.0, y: at.1 });
        let wave = wave(&map, field.centre(from), 0.1);
        let here = field.nearest_cell(at);
        if let Some(before_m) = wave.cell_distance_m(&field, here) {
            let ahead = wave.ahead(&field, &map, at).unwrap();
            let next = wave.next(&field, here).map(|cell| field.centre(cell));
            let is_next = Some(ahead) == next || ahead == field.centre(from);
            prop_assert!(is_next || wave.is_open_between(&field, at, ahead));
            let left_m = wave.cell_distance_m(&field, field.nearest_cell(ahead));
            prop_assert!(left_m.is_none_or(|left_m| left_m < before_m || before_m == 0.0));
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
fn a_way_leads_around_a_wall() {
    let map = drawn(WALL);
    let wave = wave(&map, place(12, 1), 0.4);
    let mut at = place(1, 1);
    let mut highest_m = 0.0_f64;
    for _ in 0..20 {
        at = wave.ahead(&field(), &map, at).unwrap();
        highest_m = highest_m.max(at.y);
    }
    assert_eq!(at, place(12, 1));
    assert!(highest_m > 4.5, "{highest_m}");
}

#[test]
fn an_aim_close_behind_a_wall_is_come_to_around_it() {
    for radius_m in [0.1, 0.6] {
        let map = drawn(WALL);
        let wave = wave(&map, place(7, 3), radius_m);
        let here = field().nearest_cell(place(5, 3));
        let out_m = || {
            wave.out_of(&field(), &map, place(5, 3))
                .map(|(_, way_m)| way_m)
        };
        let way_m = wave.cell_distance_m(&field(), here).or_else(out_m).unwrap();
        assert!(way_m > 6.0, "{way_m}");
    }
}

#[test]
fn who_grazes_a_wall_comes_off_it() {
    let map = drawn(WALL);
    let wave = wave(&map, place(1, 9), 0.6);
    let grazing = place(5, 3);
    assert!(wave.is_shut(&field(), field().nearest_cell(grazing)));
    assert!(wave.ahead(&field(), &map, grazing).unwrap().x < grazing.x);
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
fn no_way_leads_through_a_gap_that_is_too_narrow() {
    let map = drawn(GAP_AND_DOOR);
    let outside = place(10, 3);
    let inside = field().nearest_cell(place(2, 3));
    let slim = wave(&map, outside, 0.1);
    let stout = wave(&map, outside, 0.6);
    assert_eq!(slim.cell_distance_m(&field(), inside), Some(4.0));
    assert_eq!(stout.cell_distance_m(&field(), inside), None);
}

#[test]
fn before_a_narrow_gap_one_turns_to_the_wide_door() {
    let mut rows = GAP_AND_DOOR;
    rows[3] = "..............";
    let map = drawn(rows);
    // Both right before the gap: one wants to be on its other side.
    let wave = wave(&map, place(8, 3), 0.6);
    let way = way_down(&wave, field().nearest_cell(place(4, 3)));
    let gap = field().nearest_cell(place(6, 3));
    assert!(way.len() > 8 && !way.contains(&gap), "{way:?}");
}

#[test]
fn a_wall_aslant_has_no_cracks() {
    let map = map(|column, row| column == row);
    for (radius_m, aim) in [(0.1, [8, 2]), (0.6, [8, 2]), (0.6, [8, 7]), (0.1, [8, 7])] {
        let wave = wave(&map, place(aim[0], aim[1]), radius_m);
        let beyond = field().nearest_cell(place(2, 8));
        assert_eq!(wave.cell_distance_m(&field(), beyond), None, "{radius_m}");
    }
}
