//! Configurations of a study, and blocks of their runs.

use crate::arguments::{Arguments, MAX_RUNS};
use crate::engines::ENGINES;
use crate::error::input_error;
use crate::long_work::interruptible;
use crate::scenario::{Source, value};
use base::document::Value;
use base::engine::{BlockOptions, Bounds, Column, ColumnKind, Runner};
use base::scenario::{read_configuration as read_configuration_of, warnings as warnings_of};
use base::warning::Warning;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// Maximum runs per task of the thread pool: starting a task costs less than a microsecond.
const RUNS_PER_TASK: u64 = 16;

/// Tasks per thread if there are few runs, because some runs take longer than others.
const TASKS_PER_THREAD: u64 = 4;

/// Tasks whose results are buffered before they are joined, to limit memory.
const TASKS_BEFORE_JOINING: usize = 4096;

pub(crate) type ColumnTuple = (String, &'static str, Option<f64>, Option<f64>);

/// A scenario with values for all factors of a study, ready to run.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Configuration {
    runner: Box<dyn Runner>,
}

#[pymethods]
impl Configuration {
    /// The outcome columns: (name, kind, min, max); a bound is None if there is none.
    #[getter]
    fn columns(&self) -> Vec<ColumnTuple> {
        let columns = self.runner.columns();
        columns.iter().map(as_tuple).collect()
    }
}

pub(crate) fn as_tuple(column: &Column) -> ColumnTuple {
    let kind = match column.kind {
        ColumnKind::Whole => "whole",
        ColumnKind::Real => "real",
        ColumnKind::Flag => "flag",
    };
    let Bounds { min, max } = column.bounds;
    (column.name.to_string(), kind, min, max)
}

/// The configuration of a source, with `values` at the paths of factors. Only the parts that a run depends
/// on are read and checked.
#[pyfunction]
pub(crate) fn read_configuration(
    source: Source,
    values: &Bound<PyDict>,
) -> PyResult<Configuration> {
    let file = source.file.clone();
    let document = source.document()?;
    let read = read_configuration_of(&ENGINES, document, &values_of(values)?);
    let read = read.map_err(|errors| input_error(&errors, &file))?;
    Ok(Configuration {
        runner: read.runner,
    })
}

/// The warnings about configurations of a valid source, as dicts.
#[pyfunction]
pub(crate) fn scenario_warnings<'py>(
    py: Python<'py>,
    source: Source,
    configurations: Vec<Bound<'py, PyDict>>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let file = source.file.clone();
    let document = source.document()?;
    let configurations = configurations.into_iter();
    let configurations = configurations.map(|values| values_of(&values));
    let configurations: Vec<_> = configurations.collect::<PyResult<_>>()?;
    let warnings = py.detach(|| warnings_of(&ENGINES, &document, &configurations));
    let dicts = warnings
        .iter()
        .map(|warning| warning_dict(py, warning, &file));
    dicts.collect()
}

/// A warning as a dict.
pub(crate) fn warning_dict<'py>(
    py: Python<'py>,
    warning: &Warning,
    file: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let place = warning.place(file);
    let dict = PyDict::new(py);
    dict.set_item("origin", &warning.origin)?;
    dict.set_item("file", place.map(|(file, _)| file))?;
    dict.set_item("line", place.and_then(|(_, line)| line))?;
    dict.set_item("path", &warning.path)?;
    dict.set_item("value", &warning.value)?;
    dict.set_item("effect", &warning.effect)?;
    dict.set_item("message", warning.to_string())?;
    Ok(dict)
}

/// The values of a configuration by path.
fn values_of(values: &Bound<PyDict>) -> PyResult<Vec<(String, Value)>> {
    let values = values.iter().map(|(path, given)| {
        let path: String = path.extract()?;
        let value = value(std::slice::from_ref(&path), &given, "study.vary")?;
        Ok((path, value))
    });
    values.collect()
}

/// The runs of several configurations from `first_run` on: by column, an array (configurations, runs).
#[pyfunction]
#[pyo3(signature = (configurations, *, seed, first_run, runs, threads))]
#[expect(
    clippy::too_many_arguments,
    reason = "Python's keywords arrive one by one"
)]
pub(crate) fn run_block<'py>(
    py: Python<'py>,
    configurations: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    first_run: &Bound<'py, PyAny>,
    runs: &Bound<'py, PyAny>,
    threads: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let check = Arguments::default();
    let given = given_configurations(&check, configurations);
    let seed = check.seed(seed);
    let count = given.as_ref().map_or(1, Vec::len).max(1) as u64;
    let runs = check.integer("runs", runs, 0..=MAX_RUNS / count);
    let first_run = check.run("first_run", first_run);
    let threads = check.threads(threads);
    let all = (|| Some((given?, seed?, first_run?, runs?, threads?)))();
    let (given, seed, first_run, runs, threads) = check.or_errors(all)?;
    let runners: Vec<&dyn Runner> = given.iter().map(|each| &*each.get().runner).collect();
    let runs = first_run..first_run + runs;
    let columns = interruptible(py, threads, |stop| in_tasks(&runners, seed, &runs, stop))?;
    as_dict(py, &runners, columns)
}

/// The outcome of one run by column, the same as in [`run_block`].
#[pyfunction]
#[pyo3(signature = (configuration, *, seed, run))]
pub(crate) fn run_one<'py>(
    py: Python<'py>,
    configuration: &Bound<'py, Configuration>,
    seed: &Bound<'py, PyAny>,
    run: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let check = Arguments::default();
    let (seed, run) = (check.seed(seed), check.run("run", run));
    let (seed, run) = check.or_errors(seed.zip(run))?;
    let runners = [&*configuration.get().runner];
    let columns = interruptible(py, None, |stop| {
        in_tasks(&runners, seed, &(run..run + 1), stop)
    })?;
    let dict = PyDict::new(py);
    for (column, values) in runners[0].columns().iter().zip(columns) {
        dict.set_item(&*column.name, values.first())?;
    }
    Ok(dict)
}

fn given_configurations<'py>(
    check: &Arguments,
    given: &Bound<'py, PyAny>,
) -> Option<Vec<Bound<'py, Configuration>>> {
    let list = given.cast::<PyList>().ok().filter(|list| !list.is_empty());
    let Some(list) = list else {
        let allowed = "a list of at least one Configuration from read_configuration";
        check.error("configurations", given, allowed.to_owned());
        return None;
    };
    let configuration = |(index, item): (usize, Bound<'py, PyAny>)| {
        let configuration = item.cast::<Configuration>().ok().cloned();
        if configuration.is_none() {
            let path = format!("configurations[{index}]");
            check.error(&path, &item, "a Configuration".to_owned());
        }
        configuration
    };
    let all: Vec<_> = list.iter().enumerate().map(configuration).collect();
    all.into_iter().collect()
}

/// All runs of all configurations, as columns with one configuration after the other.
///
/// Each task is a range of runs of one configuration. Joining the results in order gives the same columns
/// for any number of threads.
fn in_tasks(
    runners: &[&dyn Runner],
    seed: u64,
    runs: &Range<u64>,
    stop: &AtomicBool,
) -> Vec<Vec<f64>> {
    let threads = rayon::current_num_threads() as u64;
    let total = (runs.end - runs.start) * runners.len() as u64;
    let options = BlockOptions {
        stop,
        may_share: total < threads,
    };
    let per_task = (total / (threads * TASKS_PER_THREAD)).clamp(1, RUNS_PER_TASK);
    let tasks = runners
        .iter()
        .flat_map(|runner| parts(runs, per_task).map(move |part| (runner, part)));
    let tasks: Vec<_> = tasks.collect();
    let mut columns = vec![Vec::new(); number_of_columns(runners)];
    for some in tasks.chunks(TASKS_BEFORE_JOINING) {
        let done = some.par_iter().with_max_len(1).map(|(runner, part)| {
            (!options.is_stopped()).then(|| runner.run_block(seed, part.clone(), options))
        });
        let done: Vec<Option<Vec<Vec<f64>>>> = done.collect();
        for block in done.into_iter().flatten() {
            for (column, values) in columns.iter_mut().zip(block) {
                column.extend(values);
            }
        }
    }
    columns
}

/// Splits `runs` into ranges of at most `length`.
fn parts(runs: &Range<u64>, length: u64) -> impl Iterator<Item = Range<u64>> {
    let Range { start, end } = *runs;
    let firsts = (0..(end - start).div_ceil(length)).map(move |part| start + part * length);
    firsts.map(move |first| first..end.min(first + length))
}

fn number_of_columns(runners: &[&dyn Runner]) -> usize {
    runners.first().map_or(0, |runner| runner.columns().len())
}

fn as_dict<'py>(
    py: Python<'py>,
    runners: &[&dyn Runner],
    columns: Vec<Vec<f64>>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let names = runners.first().map(|runner| runner.columns());
    for (column, values) in names.into_iter().flatten().zip(columns) {
        let shape = [runners.len(), values.len() / runners.len()];
        let array: Bound<PyArray2<f64>> = values.into_pyarray(py).reshape(shape)?;
        dict.set_item(&*column.name, array)?;
    }
    Ok(dict)
}
