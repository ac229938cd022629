//! The plain form gives exactly the traces of the original program, floats equal and not close.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use classic::{Colour, Contact, Heading, Robot, Search, Speed, Start, Task, trace};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn speed(number: &Value) -> Speed {
    match number.as_i64() {
        Some(0) => Speed::Stopped,
        Some(1) => Speed::Slow,
        _ => Speed::Fast,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the files hold 32-bit floats, widened"
)]
fn start(robot: &Value) -> Start {
    Start {
        x_px: robot["x"].as_f64().unwrap() as f32,
        y_px: robot["y"].as_f64().unwrap() as f32,
        heading: Heading::new(robot["heading"].as_i64().unwrap()).unwrap(),
        speed: speed(&robot["speed"]),
    }
}

fn robot_row(robot: &Robot) -> Value {
    let colour = match robot.colour {
        Colour::Blue => "b",
        Colour::Yellow => "y",
        Colour::Red => "r",
    };
    json!([
        f64::from(robot.x_px),
        f64::from(robot.y_px),
        robot.heading.degrees(),
        robot.speed.number(),
        robot.left_turns,
        robot.right_turns,
        colour,
    ])
}

fn assert_same_run(case: &Value) {
    let starts: Vec<Start> = case["start"]
        .as_array()
        .unwrap()
        .iter()
        .map(start)
        .collect();
    let decisions = case["decisions"].as_array().unwrap();
    let trace = trace(&starts, decisions.len());
    let id = &case["id"];
    assert_eq!(
        trace.decisions.len(),
        decisions.len(),
        "case {id}: decisions"
    );
    assert_eq!(
        trace.paints.len(),
        case["paints"].as_array().unwrap().len(),
        "case {id}: paints"
    );
    assert_eq!(
        case["start_grid"], trace.start_grid,
        "case {id}: start grid"
    );
    for (number, (expected, pixels)) in case["paints"]
        .as_array()
        .unwrap()
        .iter()
        .zip(&trace.paints)
        .enumerate()
    {
        let row: Vec<_> = pixels.iter().map(|pixels| pixels.map(f64::from)).collect();
        assert_eq!(expected, &json!(row), "case {id}: paint {}", number + 1);
    }
    for (number, (expected, decided)) in decisions.iter().zip(&trace.decisions).enumerate() {
        let mut row = vec![json!(decided.carry), json!(decided.grid)];
        row.extend(decided.robots.iter().map(robot_row));
        assert_eq!(
            expected,
            &Value::Array(row),
            "case {id}: decision {}",
            number + 1
        );
    }
}

/// Every decision of a run that is stepped and judged is the case's.
fn assert_same_when_judged(case: &Value) {
    let starts = case["start"].as_array().unwrap().iter();
    let starts: Vec<Start> = starts.map(start).collect();
    let task = Task {
        contact: Contact::Touch,
        time_limit_paints: 0,
    };
    let mut search = Search::new(&starts, task);
    for decided in case["decisions"].as_array().unwrap() {
        let paint = search.simulation().paint();
        (0..if paint == 0 { 12 } else { 11 }).for_each(|_| search.step());
        let robots: Vec<Value> = search.simulation().robots().iter().map(robot_row).collect();
        assert_eq!(decided[0], search.simulation().carry());
        assert_eq!(
            decided.as_array().unwrap()[2..],
            robots,
            "case {}",
            case["id"]
        );
    }
}

#[test]
fn the_plain_form_reproduces_every_golden_trace() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/traces");
    let mut cases = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap();
        let case = serde_json::from_str(&text).unwrap();
        assert_same_run(&case);
        assert_same_when_judged(&case);
        cases += 1;
    }
    assert_eq!(cases, 56);
}
