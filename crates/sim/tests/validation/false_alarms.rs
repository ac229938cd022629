//! False alarms are a Poisson process over the visible area.

use crate::rows::{Row, assert_published, assert_right, assert_wrong};
use crate::setup::{list, places, run, scenario};
use base::document::{Node, Table, Value};
use base::geometry::Point;
use std::f64::consts::PI;

const TEXT: &str = include_str!("../../../../docs/validation/false-alarms.toml");
const RANGE_M: f64 = 2.0;

/// False alarms per measurement and square metre of visible area: 1.6 per second at 10 Hz.
const PER_M2: f64 = 0.16;
const SCANS: u32 = 40_000;

/// Counts from this value on are grouped.
const MANY: u64 = 6;

/// Area of the part of a disc on its centre's side of a line at a distance.
fn before_a_line_m2(radius_m: f64, line_m: f64) -> f64 {
    let square = radius_m * radius_m;
    let beyond =
        square * libm::acos(line_m / radius_m) - line_m * (square - line_m * line_m).sqrt();
    PI * square - beyond
}

/// A name, changed values of the scenario, and the visible area.
type View = (&'static str, Vec<(&'static str, Value)>, f64);

/// Positions of the robot and obstacles that hide a part of its view, with the visible area.
fn views() -> [View; 3] {
    let start = |x, y| ("robots.watcher.start.at_m", places([Point { x, y }]));
    let corners = [(21.0, 0.0), (22.0, 0.0), (22.0, 40.0), (21.0, 40.0)];
    let corners = places(corners.map(|(x, y)| Point { x, y }));
    let node = Node {
        value: corners,
        origin: "the check".to_owned(),
    };
    let wall = Value::Table(Table::from([("polygon_m".to_owned(), node)]));
    [
        ("open", vec![], PI * RANGE_M * RANGE_M),
        (
            "1 m before a wall",
            vec![("world.obstacles", list([wall]))],
            before_a_line_m2(RANGE_M, 1.0),
        ),
        (
            "0.5 m before the border",
            vec![start(0.5, 20.0)],
            before_a_line_m2(RANGE_M, 0.5),
        ),
    ]
}

/// The number of measurements with each count.
fn counts(changes: &[(&str, Value)]) -> Vec<u32> {
    let mut simulation = run(&scenario(TEXT, changes), 1, 0);
    let mut counts = vec![0; usize::try_from(MANY).unwrap() + 1];
    let mut before = 0;
    for _ in 0..SCANS {
        simulation.step();
        let so_far = simulation.outcome().false_alarms;
        counts[usize::try_from((so_far - before).min(MANY)).unwrap()] += 1;
        before = so_far;
    }
    counts
}

/// Probabilities of 0, 1, ... and of `MANY` or more.
fn poisson(mean: f64) -> Vec<f64> {
    let mut left = 1.0;
    let mut probability = libm::exp(-mean);
    let mut all = Vec::new();
    for count in 1..=MANY {
        all.push(probability);
        left -= probability;
        probability *= mean / f64::from(u32::try_from(count).unwrap());
    }
    all.push(left);
    all
}

/// Rows for an expected rate, which may differ from that of the scenario.
fn rows(per_m2: f64) -> Vec<Row> {
    let views = views().into_iter();
    let rows = views.flat_map(|(series, changes, area_m2)| {
        let counts = counts(&changes).into_iter();
        let shares = counts.zip(poisson(per_m2 * area_m2));
        let rows = (0..).zip(shares).map(move |(count, (scans, probability))| {
            Row::share(series, f64::from(count), scans, SCANS, probability)
        });
        rows.collect::<Vec<_>>()
    });
    rows.collect()
}

#[test]
fn false_alarms_per_measurement_are_poisson_with_a_mean_proportional_to_the_visible_area() {
    let rows = rows(PER_M2);
    assert_published("false-alarms.csv", &rows);
    assert_right(&rows);
}

#[test]
fn a_false_alarm_rate_5_percent_off_is_detected() {
    assert_wrong(&rows(1.05 * PER_M2));
}
