//! The plain form gives exactly the traces of the original program, floats equal and not close.

use super::*;
use crate::contact::Contact;
use crate::heading::Turn;
use crate::search::{Search, Task};
use crate::world::cells;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Number of paints that a file records one by one.
const RECORDED_PAINTS: u64 = 34;

fn heading(degrees: u64) -> Heading {
    match degrees {
        360 => Heading::of_octant(7).turned(Turn::Right),
        _ => Heading::of_octant(usize::try_from(degrees / 45).unwrap()),
    }
}

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
    let start = Start {
        x_px: robot["x"].as_f64().unwrap() as f32,
        y_px: robot["y"].as_f64().unwrap() as f32,
        heading: heading(robot["heading"].as_u64().unwrap()),
        speed: speed(&robot["speed"]),
    };
    assert_eq!(robot["heading"], start.heading.degrees());
    start
}

fn starts(case: &Value) -> Vec<Start> {
    let robots = case["start"].as_array().unwrap();
    robots.iter().map(start).collect()
}

/// FNV-1a over the counts of the cells modulo 256, as eight hex digits.
fn hash(grid: &Grid) -> String {
    let counts = cells().map(|cell| grid.count(cell).unwrap());
    let step = |hash: u32, count: u32| (hash ^ (count & 0xff)).wrapping_mul(16_777_619);
    format!("{:08x}", counts.fold(0x811c_9dc5, step))
}

fn pixels(robots: &[Robot]) -> Value {
    let pixels = |robot: &Robot| [f64::from(robot.x_px), f64::from(robot.y_px)];
    json!(robots.iter().map(pixels).collect::<Vec<_>>())
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
    let mut run = Simulation::new(&starts(case));
    assert_eq!(case["start_grid"], hash(&run.grid));
    let (mut paints, mut decisions) = (Vec::new(), Vec::new());
    let number_of_decisions = case["decisions"].as_array().unwrap().len();
    while run.paint < RECORDED_PAINTS || decisions.len() < number_of_decisions {
        if run.step() {
            let mut row = vec![json!(run.carry), json!(hash(&run.grid))];
            row.extend(run.robots.iter().map(robot_row));
            decisions.push(Value::Array(row));
        }
        if run.paint <= RECORDED_PAINTS {
            paints.push(pixels(&run.robots));
        }
    }
    let id = &case["id"];
    assert_eq!(case["paints"], Value::Array(paints), "case {id}: paints");
    for (number, (expected, row)) in
        (1..).zip(case["decisions"].as_array().unwrap().iter().zip(decisions))
    {
        assert_eq!(*expected, row, "case {id}: decision {number}");
    }
}

/// Every decision of a run that is stepped and judged is the case's.
fn assert_same_when_judged(case: &Value) {
    let task = Task {
        contact: Contact::Touch,
        time_limit_paints: 0,
    };
    let mut search = Search::new(&starts(case), task);
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
