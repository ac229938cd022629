//! Starts and traces of the classic engine, in the form of the golden trace files.

use crate::arguments::Arguments;
use classic::start::{MAX_ROBOTS, random_team};
use classic::trace::{Decided, Trace};
use classic::world::SIZE;
use classic::{Colour, Heading, Robot, Speed, Start};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList};

/// Maximum robot-decisions of a trace: a second of computing, and some hundred megabytes of Python lists.
const MAX_ROBOT_DECISIONS: u64 = 1_000_000;
const KEYS: [&str; 4] = ["x", "y", "heading", "speed"];

/// A team's start in one run, in the form that [`trace`] takes.
#[pyfunction]
pub(crate) fn random_start<'py>(
    py: Python<'py>,
    robots: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    run: &Bound<'py, PyAny>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let check = Arguments::default();
    let robots = check.robots(robots, MAX_ROBOTS);
    let seed = check.integer("seed", seed, 0..=u64::MAX);
    let run = check.integer("run", run, 0..=u64::MAX);
    let all = (|| Some((robots?, seed?, run?)))();
    let (robots, seed, run) = check.or_errors(all)?;
    let row = |start: &Start| {
        let row = PyDict::new(py);
        row.set_item("x", start.x_px)?;
        row.set_item("y", start.y_px)?;
        row.set_item("heading", start.heading.degrees())?;
        row.set_item("speed", start.speed.number())?;
        Ok(row)
    };
    random_team(robots, seed, run).iter().map(row).collect()
}

/// A run of the plain form from `start`, with the keys and shapes of the golden trace files.
#[pyfunction]
pub(crate) fn trace<'py>(
    py: Python<'py>,
    start: &Bound<'py, PyAny>,
    decisions: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let check = Arguments::default();
    let starts = starts(&check, start);
    let robots = starts.as_ref().map_or(1, |starts| starts.len() as u64);
    let decisions = check.integer("decisions", decisions, 0..=MAX_ROBOT_DECISIONS / robots);
    let (starts, decisions) = check.or_errors(starts.zip(decisions))?;
    let decisions = usize::try_from(decisions)?;
    let trace = py.detach(|| classic::trace(&starts, decisions));
    as_dict(py, &trace)
}

fn starts(check: &Arguments, given: &Bound<PyAny>) -> Option<Vec<Start>> {
    let rows = given
        .cast::<PyList>()
        .ok()
        .filter(|rows| (1..=MAX_ROBOTS as usize).contains(&rows.len()));
    let Some(rows) = rows else {
        let allowed = format!("a list of 1 to {MAX_ROBOTS} dicts with {}", KEYS.join(", "));
        check.error("start", given, allowed);
        return None;
    };
    let starts: Vec<Option<Start>> = rows
        .iter()
        .enumerate()
        .map(|(index, row)| start(check, &format!("start[{index}]"), &row))
        .collect();
    starts.into_iter().collect()
}

fn start(check: &Arguments, path: &str, given: &Bound<PyAny>) -> Option<Start> {
    let has_all_keys = |row: &&Bound<PyDict>| {
        row.len() == KEYS.len() && KEYS.iter().all(|key| row.contains(key).unwrap_or(false))
    };
    let Some(row) = given.cast::<PyDict>().ok().filter(has_all_keys) else {
        check.error(
            path,
            given,
            format!("a dict with exactly {}", KEYS.join(", ")),
        );
        return None;
    };
    let value = |key: &str| row.get_item(key).ok().flatten();
    let x_px = pixels(check, &format!("{path}.x"), &value("x")?);
    let y_px = pixels(check, &format!("{path}.y"), &value("y")?);
    let heading = heading(check, &format!("{path}.heading"), &value("heading")?);
    let speed = speed(check, &format!("{path}.speed"), &value("speed")?);
    Some(Start {
        x_px: x_px?,
        y_px: y_px?,
        heading: heading?,
        speed: speed?,
    })
}

/// A pixel coordinate whose cell is in the grid, as a 32-bit float.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the simulator's pixels have 32 bits"
)]
fn pixels(check: &Arguments, path: &str, given: &Bound<PyAny>) -> Option<f32> {
    let number = (!given.is_instance_of::<PyBool>()).then(|| given.extract::<f64>().ok());
    let px = number.flatten().map(|number| number as f32);
    let is_on_grid = |px: &f32| {
        let start = Start {
            x_px: *px,
            y_px: 0.0,
            heading: Heading::of_octant(0),
            speed: Speed::Slow,
        };
        px.is_finite() && (0..SIZE).contains(&start.cell().x)
    };
    let px = px.filter(is_on_grid);
    if px.is_none() {
        let allowed = format!(
            "a number of pixels on the grid: from -10 to below {} (20 px a cell, halves round up)",
            SIZE * 20 - 10
        );
        check.error(path, given, allowed);
    }
    px
}

fn heading(check: &Arguments, path: &str, given: &Bound<PyAny>) -> Option<Heading> {
    let degrees = (!given.is_instance_of::<PyBool>()).then(|| given.extract::<i64>().ok());
    let heading = degrees.flatten().and_then(Heading::new);
    if heading.is_none() {
        check.error(
            path,
            given,
            "one of 0, 45, 90, 135, 180, 225, 270, 315, 360".to_owned(),
        );
    }
    heading
}

fn speed(check: &Arguments, path: &str, given: &Bound<PyAny>) -> Option<Speed> {
    match check.integer(path, given, 0..=2)? {
        0 => Some(Speed::Stopped),
        1 => Some(Speed::Slow),
        _ => Some(Speed::Fast),
    }
}

fn as_dict<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("start_grid", &trace.start_grid)?;
    let pixels = |robots: &Vec<[f32; 2]>| robots.iter().map(|pixels| pixels.to_vec()).collect();
    let paints: Vec<Vec<Vec<f32>>> = trace.paints.iter().map(pixels).collect();
    dict.set_item("paints", paints)?;
    let decisions: PyResult<Vec<_>> = trace
        .decisions
        .iter()
        .map(|row| decision(py, row))
        .collect();
    dict.set_item("decisions", decisions?)?;
    Ok(dict)
}

fn decision<'py>(py: Python<'py>, decided: &Decided) -> PyResult<Bound<'py, PyList>> {
    let row = PyList::empty(py);
    row.append(decided.carry)?;
    row.append(&decided.grid)?;
    for robot in &decided.robots {
        row.append(robot_row(py, robot)?)?;
    }
    Ok(row)
}

fn robot_row<'py>(py: Python<'py>, robot: &Robot) -> PyResult<Bound<'py, PyList>> {
    let row = PyList::new(py, [robot.x_px, robot.y_px])?;
    row.append(robot.heading.degrees())?;
    row.append(robot.speed.number())?;
    row.append(robot.left_turns)?;
    row.append(robot.right_turns)?;
    row.append(match robot.colour {
        Colour::Blue => "b",
        Colour::Yellow => "y",
        Colour::Red => "r",
    })?;
    Ok(row)
}
