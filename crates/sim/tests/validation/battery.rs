//! A battery lasts for its capacity divided by the power, to within a step.

use crate::rows::{Row, assert_published};
use crate::setup::{first_of, list, moving, only, places, run, scenario, time_s};
use base::document::{Document, Value};
use base::geometry::Point;
use brain::Command;
use sim::run::Status;
use std::collections::BTreeMap;

const TEXT: &str = include_str!("../../../../docs/validation/battery.toml");
const STEP_S: f64 = 0.1;

/// Capacities in joules, in the order of the rows.
const CAPACITIES_J: [f64; 5] = [100.0, 300.0, 1000.0, 3000.0, 10_000.0];

/// A body, its motion, and the power that it consumes.
struct Case {
    name: &'static str,
    changes: Vec<(&'static str, Value)>,
    does: Command,
    power_w: f64,
}

/// Idling consumes 7 W, moving 3 W and each metre 11 J.
fn cases() -> Vec<Case> {
    let case = |name, changes, does, power_w| Case {
        name,
        changes,
        does,
        power_w,
    };
    let circling = || moving(1.0, 1.0);
    vec![
        case("standing", vec![], moving(0.0, 0.0), 7.0),
        case("turning", vec![], moving(0.0, 1.0), 7.0 + 3.0),
        case("driving at 1 m/s", vec![], circling(), 7.0 + 3.0 + 11.0),
        case(
            "driving with half its mass more",
            vec![("robots.body.payload_kg", Value::Float(10.0))],
            circling(),
            7.0 + 3.0 + 11.0 * 1.5,
        ),
        case(
            "driving with sensors and radio of 4 W",
            electronics(),
            circling(),
            7.0 + 3.0 + 11.0 + 4.0,
        ),
        case(
            "driving in mud: half as fast with twice the effort",
            mud(),
            circling(),
            7.0 + 2.0 * (3.0 + 11.0 * 0.5),
        ),
    ]
}

fn electronics() -> Vec<(&'static str, Value)> {
    let sensor = "kind = \"position\"\npower_w = 2.5";
    let radio = "range_m = 1\npower_w = 1.5";
    vec![
        ("robots.body.sensors.gps", table(sensor)),
        ("robots.body.radio", table(radio)),
    ]
}

fn mud() -> Vec<(&'static str, Value)> {
    let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)];
    let all = places(corners.map(|(x, y)| Point { x, y }));
    vec![
        ("terrain.mud.speed", Value::Float(0.5)),
        ("terrain.mud.energy", Value::Float(2.0)),
        ("terrain.mud.areas_m", list([all])),
    ]
}

fn table(text: &str) -> Value {
    let document = Document::parse("validation", text).unwrap();
    document.get(&[]).unwrap().value.clone()
}

/// The time until the battery is empty.
fn life_s(case: &Case, capacity_j: f64) -> f64 {
    let mut changes = case.changes.clone();
    changes.push(("robots.body.battery.capacity_j", Value::Float(capacity_j)));
    let mut simulation = run(&scenario(TEXT, &changes), 1, 0);
    while only(&simulation).status == Status::Active {
        let commands = BTreeMap::from([(first_of(0), case.does.clone())]);
        simulation.step_with(BTreeMap::new(), commands).unwrap();
    }
    time_s(&simulation)
}

fn rows() -> Vec<Row> {
    let cases = cases();
    let rows = cases.iter().flat_map(|case| {
        CAPACITIES_J.map(|capacity_j| {
            let expected_s = capacity_j / case.power_w;
            Row::exact(case.name, capacity_j, life_s(case, capacity_j), expected_s)
        })
    });
    rows.collect()
}

/// It lasts until the end of the step that empties it; rounding may add a step.
fn is_within_a_step(row: &Row, expected_s: f64) -> bool {
    let more_s = row.measured - expected_s;
    (-1e-6..=STEP_S + 1e-6).contains(&more_s)
}

#[test]
fn a_battery_lasts_for_its_capacity_divided_by_the_power_to_within_a_step() {
    let rows = rows();
    assert_published("battery.csv", &rows);
    for row in &rows {
        let expected_s = row.expected.unwrap();
        assert!(is_within_a_step(row, expected_s), "{row:?}");
        // An error of 1% in the power would be detected at the largest capacity.
        let is_large = row.x == CAPACITIES_J[4];
        assert!(!is_large || !is_within_a_step(row, 1.01 * expected_s));
        assert!(!is_large || !is_within_a_step(row, 0.99 * expected_s));
    }
}
