//! Measurements are independent: the number until an item is detected is geometric.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{circle, places, run, scenario, whole};
use base::document::Value;
use base::geometry::Point;

const TEXT: &str = include_str!("../../../../docs/validation/scans.toml");
const CENTRE: Point = Point { x: 10.0, y: 10.0 };

/// Number of items at each distance, and of runs.
const ITEMS: u32 = 2000;
const RUNS: u64 = 20;

/// Number of measurements that are evaluated.
const SCANS: u32 = 8;

/// A distance, and the detection probability there.
type At = (f64, f64);

/// The table of the scenario is interpolated linearly: 0.8 is half-way from 0.9 to 0.7.
const BY_TABLE: [At; 3] = [(1.0, 0.8), (2.5, 0.45), (4.0, 0.2)];

/// The curve: 0.6 * 2^-(distance / 1.5)^2.
const BY_CURVE: [At; 3] = [(0.0, 0.6), (1.5, 0.3), (3.0, 0.0375)];

/// The number of undetected items at each distance after each measurement.
fn left(changes: &[(&str, Value)]) -> Vec<[u32; SCANS as usize]> {
    let distances = BY_TABLE.iter().chain(&BY_CURVE).count();
    let around = |at: &[At]| {
        let all = at.iter();
        places(all.flat_map(|(distance_m, _)| circle(CENTRE, *distance_m, ITEMS)))
    };
    let fixed = [
        ("items.by_table.placement.at_m", around(&BY_TABLE)),
        ("items.by_curve.placement.at_m", around(&BY_CURVE)),
        ("items.by_table.placement.kind", Value::Text("fixed".into())),
        ("items.by_curve.placement.kind", Value::Text("fixed".into())),
        ("items.by_table.count", whole(3 * ITEMS)),
        ("items.by_curve.count", whole(3 * ITEMS)),
    ];
    let scenario = scenario(TEXT, &[&fixed, changes].concat());
    let mut left = vec![[0; SCANS as usize]; distances];
    for number in 0..RUNS {
        let mut simulation = run(&scenario, 1, number);
        for scan in 0..SCANS {
            // Measurements at 5 Hz: one in two steps.
            simulation.step();
            simulation.step();
            let items = simulation.state().each_item(&scenario);
            for (item, _) in items.enumerate().filter(|(_, item)| item.found_s.is_none()) {
                left[item / ITEMS as usize][scan as usize] += 1;
            }
        }
    }
    left
}

fn rows(changes: &[(&str, Value)]) -> Vec<Row> {
    let left = left(changes);
    let all = ITEMS * u32::try_from(RUNS).unwrap();
    // Kinds of items are in alphabetical order.
    let curve = BY_CURVE.iter().map(|at| ("curve", at));
    let table = BY_TABLE.iter().map(|at| ("table", at));
    let series = curve.chain(table).zip(left);
    let rows = series.flat_map(|((name, (distance_m, probability)), left)| {
        let series = format!("{name}: {distance_m} m");
        (1..).zip(left).map(move |(scan, left)| {
            let expected = (0..scan).map(|_| 1.0 - probability).product();
            Row::share(&series, f64::from(scan), left, all, expected)
        })
    });
    // A share of few items is not normally distributed.
    let is_many = |row: &Row| {
        row.expected
            .is_some_and(|share| share * f64::from(all) > 25.0)
    };
    rows.filter(is_many).collect()
}

#[test]
fn the_number_of_measurements_until_detection_is_geometric() {
    let rows = rows(&[]);
    assert_published("scans.csv", &rows);
    assert_right(&rows);
}

#[test]
fn a_detection_probability_5_percent_off_is_detected() {
    let curve = "robots.watcher.sensors.eye.detection_probability.by_curve.peak";
    assert_wrong(&rows(&[(curve, Value::Float(0.57))]));
}
