//! Runs of the classic engine, as columns.

use crate::arguments::Arguments;
use crate::long_work::in_blocks;
use classic::clock::MAX_TIME_LIMIT_PAINTS;
use classic::replicate::{number_of_starts, start_cells};
use classic::start::MAX_ROBOTS;
use classic::{Outcome, Task};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

type Column<'py> = Bound<'py, PyArray1<i64>>;
type OutcomeColumns<'py> = (Column<'py>, Column<'py>, Column<'py>);

/// Maximum runs of one call: about half a gigabyte of outcomes and columns.
const MAX_RUNS: u64 = 10_000_000;

/// Outcomes of runs with random starts: arrays (runs,) of paints (-1 = proven never), found and
/// collisions.
#[pyfunction]
#[pyo3(signature = (robots, runs, *, contact, time_limit_paints, seed, first_run, threads))]
#[expect(
    clippy::too_many_arguments,
    reason = "Python's keywords arrive one by one"
)]
pub(crate) fn replicate<'py>(
    py: Python<'py>,
    robots: &Bound<'py, PyAny>,
    runs: &Bound<'py, PyAny>,
    contact: &Bound<'py, PyAny>,
    time_limit_paints: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    first_run: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<OutcomeColumns<'py>> {
    let check = Arguments::default();
    let robots = check.robots(robots, MAX_ROBOTS);
    let runs = check.integer("runs", runs, 0..=MAX_RUNS);
    let contact = check.contact(contact);
    let time_limit_paints = check.integer(
        "time_limit_paints",
        time_limit_paints,
        0..=MAX_TIME_LIMIT_PAINTS,
    );
    let seed = check.integer("seed", seed, 0..=u64::MAX);
    let first_run = check.integer("first_run", first_run, 0..=u64::MAX - MAX_RUNS);
    let threads = check.threads(threads);
    let task = contact
        .zip(time_limit_paints)
        .map(|(contact, time_limit_paints)| Task {
            contact,
            time_limit_paints,
        });
    let all = (|| Some((robots?, runs?, task?, seed?, first_run?, threads?)))();
    let (robots, runs, task, seed, first_run, threads) = check.or_errors(all)?;
    let outcomes = in_blocks(py, first_run..first_run + runs, threads, |runs| {
        classic::replicate(robots, runs, seed, task)
    })?;
    Ok(columns(py, &outcomes))
}

/// Every possible start of one or two robots: an array (starts, 2 x robots) of their cells
/// (x, y of robot 0, then of robot 1), and (starts,) of paints (-1 = proven never).
#[pyfunction]
#[pyo3(signature = (robots, contact, *, threads))]
pub(crate) fn exhaust<'py>(
    py: Python<'py>,
    robots: &Bound<'py, PyAny>,
    contact: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyArray2<i64>>, Column<'py>)> {
    let check = Arguments::default();
    let robots = check.robots(robots, 2);
    let contact = check.contact(contact);
    let threads = check.threads(threads);
    let all = (|| Some((robots?, contact?, threads?)))();
    let (robots, contact, threads) = check.or_errors(all)?;
    let starts = number_of_starts(robots).unwrap_or_default();
    let task = Task {
        contact,
        time_limit_paints: 0,
    };
    let outcomes = in_blocks(py, 0..starts, threads, |starts| {
        classic::replicate::exhaust(robots, starts, task)
    })?;
    let cells = (0..starts).flat_map(|start| start_cells(robots, start));
    let coordinates: Vec<i64> = cells
        .flat_map(|cell| [cell.x.into(), cell.y.into()])
        .collect();
    let shape = [outcomes.len(), 2 * robots as usize];
    let coordinates = coordinates.into_pyarray(py).reshape(shape)?;
    Ok((coordinates, columns(py, &outcomes).0))
}

fn columns<'py>(py: Python<'py>, outcomes: &[Outcome]) -> OutcomeColumns<'py> {
    let column = |value: fn(&Outcome) -> i64| {
        outcomes
            .iter()
            .map(value)
            .collect::<Vec<i64>>()
            .into_pyarray(py)
    };
    (
        column(|outcome| outcome.paints.map_or(-1, u64::cast_signed)),
        column(|outcome| outcome.found.into()),
        column(|outcome| outcome.collisions.cast_signed()),
    )
}
