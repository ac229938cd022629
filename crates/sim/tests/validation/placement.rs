//! Uniform placement is uniform over the free area.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{places, robots, run, scenario};
use base::document::Value;
use base::geometry::Point;

const TEXT: &str = include_str!("../../../../docs/validation/placement.toml");
const RUNS: u64 = 400;

/// Squares of 1 m in 10 rows of 20; a block covers two rows of four in the middle.
const SIZE: [usize; 2] = [20, 10];
const BLOCKED: u32 = 8;

fn is_blocked(column: usize, row: usize) -> bool {
    (8..12).contains(&column) && (4..6).contains(&row)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within the world"
)]
fn square(place: Point) -> usize {
    let [columns, rows] = SIZE;
    (place.y as usize).min(rows - 1) * columns + (place.x as usize).min(columns - 1)
}

/// The numbers of items and robots in each square, over all runs.
fn counts(changes: &[(&str, Value)]) -> [Vec<u32>; 2] {
    let scenario = scenario(TEXT, changes);
    let mut counts = [vec![0; SIZE[0] * SIZE[1]], vec![0; SIZE[0] * SIZE[1]]];
    for number in 0..RUNS {
        let simulation = run(&scenario, 1, number);
        for item in simulation.state().each_item(&scenario) {
            counts[0][square(item.at)] += 1;
        }
        for robot in robots(&simulation) {
            counts[1][square(robot.at)] += 1;
        }
    }
    counts
}

/// Share of items in each square.
fn items(counts: &[u32]) -> Vec<Row> {
    let all = counts.iter().sum();
    let free = 200 - BLOCKED;
    let squares = counts.iter().enumerate().map(|(square, count)| {
        let (column, row) = (square % SIZE[0], square / SIZE[0]);
        let is_free = !is_blocked(column, row);
        let expected = if is_free { 1.0 / f64::from(free) } else { 0.0 };
        let number = f64::from(u32::try_from(square).unwrap());
        Row::share("items", number, *count, all, expected)
    });
    squares.collect()
}

/// Share of robots in each column. Their centres keep 0.1 m from walls and from the block; its
/// rounded corners change the area by less than a square centimetre.
fn robots_by_column(counts: &[u32]) -> Vec<Row> {
    const RADIUS_M: f64 = 0.1;
    let height_m = 10.0 - 2.0 * RADIUS_M;
    let blocked_m = 2.0 + 2.0 * RADIUS_M;
    let area_m2 = |column: usize| match column {
        0 | 19 => (1.0 - RADIUS_M) * height_m,
        7 | 12 => height_m - RADIUS_M * blocked_m,
        8..12 => height_m - blocked_m,
        _ => height_m,
    };
    let total_m2: f64 = (0..SIZE[0]).map(area_m2).sum();
    let all = counts.iter().sum();
    let columns = (0..SIZE[0]).map(|column| {
        let count = counts.iter().skip(column).step_by(SIZE[0]).sum();
        let number = f64::from(u32::try_from(column).unwrap());
        Row::share("robots", number, count, all, area_m2(column) / total_m2)
    });
    columns.collect()
}

#[test]
fn items_and_robots_are_uniform_over_the_free_area() {
    let [in_squares, robots] = counts(&[]);
    let rows = [items(&in_squares), robots_by_column(&robots)].concat();
    assert_published("placement.csv", &rows);
    assert_right(&rows);
    let mut blocked = rows.iter().filter(|row| row.expected == Some(0.0));
    assert!(blocked.all(|row| row.measured == 0.0));
}

#[test]
fn items_in_only_99_percent_of_the_field_are_detected() {
    let within = places([Point::default(), Point { x: 19.8, y: 10.0 }]);
    let [in_squares, _] = counts(&[
        ("items.target.placement.kind", Value::Text("uniform".into())),
        ("items.target.placement.within_m", within),
    ]);
    assert_wrong(&items(&in_squares));
}

#[test]
fn a_larger_radius_of_robots_is_detected() {
    let [_, robots] = counts(&[("robots.rover.radius_m", Value::Float(0.5))]);
    assert_wrong(&robots_by_column(&robots));
}
