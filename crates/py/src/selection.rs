//! Selection procedures, and bounds of means.

use crate::error::InputError;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use select::bounds::{mean_bounds as bounds_of_mean, mean_exceeds as exceeds};
use select::quantiles::quantile_bounds as bounds_of_quantile;
use select::{Bounds, EqualAllocation, Problem, Race, Requirement, RequirementProblem, Strict};
use std::sync::{Mutex, PoisonError};

/// Maximum number of configurations of a selection.
const MAX_CONFIGURATIONS: usize = 100_000;

/// A selection procedure, between two of its rounds.
///
/// Its callers in Python check what users pass; a wrong argument here is a bug.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Procedure(Mutex<Box<dyn select::Exclude + Send>>);

impl Procedure {
    fn with<T>(&self, act: impl FnOnce(&mut (dyn select::Exclude + Send)) -> T) -> T {
        let mut procedure = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        act(procedure.as_mut())
    }
}

type Request<'py> = (Bound<'py, PyArray1<i64>>, u64, usize);

#[pymethods]
impl Procedure {
    /// Configurations, first run and number of runs that it needs next; None when it has selected.
    fn next<'py>(&self, py: Python<'py>) -> Option<Request<'py>> {
        let request = self.with(|procedure| procedure.next())?;
        let configurations = indices(py, request.configurations);
        Some((configurations, request.first_run, request.runs))
    }

    /// Records a number for each run that `next` requested: shape (configurations, runs).
    fn record(&self, py: Python, values: &Bound<PyArray2<f64>>) -> PyResult<()> {
        let request = self.with(|procedure| procedure.next());
        let rows = request.map_or(0, |request| request.configurations.len());
        let shape = values.shape();
        if shape[0] != rows || shape[1] == 0 {
            let message = format!("values have shape {shape:?}: must be a row for each of {rows}");
            return Err(InputError::new_err(message));
        }
        // Copied, so that the procedure can run without holding the interpreter.
        let values: Vec<f64> = values.readonly().as_array().iter().copied().collect();
        py.detach(|| self.with(|procedure| procedure.record(&values)));
        Ok(())
    }

    /// Removes configurations that cannot be run, before the first `record`; at least one remains.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
    fn exclude(&self, configurations: Vec<usize>) {
        self.with(|procedure| procedure.exclude(&configurations));
    }

    /// The selected configuration, or the currently leading one; None if there is none.
    #[getter]
    fn selected(&self) -> Option<usize> {
        self.with(|procedure| procedure.selected())
    }

    /// Configurations that are shown to meet a requirement, ascending.
    #[getter]
    fn certified<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        indices(py, self.with(|procedure| procedure.certified()))
    }

    /// Configurations that are shown not to meet a requirement at all, ascending.
    #[getter]
    fn below<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        indices(py, self.with(|procedure| procedure.below()))
    }

    /// Whether its promise holds; it may request further runs that make it more precise.
    #[getter]
    fn is_settled(&self) -> bool {
        self.with(|procedure| procedure.is_settled())
    }

    /// Number of runs per configuration.
    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let runs = self.with(|procedure| procedure.runs());
        let runs: Vec<i64> = runs.into_iter().map(u64::cast_signed).collect();
        runs.into_pyarray(py)
    }

    /// Configurations that can still be selected, ascending.
    #[getter]
    fn survivors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        indices(py, self.with(|procedure| procedure.survivors()))
    }

    /// The eliminations in order: (configuration, the one that eliminated it if one did, its number of
    /// runs).
    #[getter]
    fn eliminations(&self) -> Vec<(usize, Option<usize>, u64)> {
        let eliminations = self.with(|procedure| procedure.eliminations());
        eliminations
            .into_iter()
            .map(|each| (each.configuration, each.by, each.runs))
            .collect()
    }
}

fn indices(py: Python<'_>, configurations: Vec<usize>) -> Bound<'_, PyArray1<i64>> {
    let signed = configurations.into_iter().map(usize::cast_signed);
    signed
        .map(|index| index as i64)
        .collect::<Vec<i64>>()
        .into_pyarray(py)
}

/// The race ("indifference") or the strict procedure ("pgs") for configurations whose merits lie
/// within `bounds`: shape (configurations, 2).
#[pyfunction]
#[pyo3(signature = (bounds, *, delta, confidence, guarantee))]
pub(crate) fn selection(
    bounds: &Bound<PyArray2<f64>>,
    delta: f64,
    confidence: f64,
    guarantee: &str,
) -> PyResult<Procedure> {
    let problem = Problem {
        bounds: rows(bounds)?,
        delta,
        confidence,
    };
    let procedure: Box<dyn select::Exclude + Send> = match guarantee {
        "indifference" => Box::new(Race::new(problem)),
        "pgs" => Box::new(Strict::new(problem)),
        other => {
            let message =
                format!("guarantee = {other:?}: must be one of \"indifference\", \"pgs\"");
            return Err(InputError::new_err(message));
        }
    };
    Ok(Procedure(Mutex::new(procedure)))
}

fn rows(bounds: &Bound<PyArray2<f64>>) -> PyResult<Vec<Bounds>> {
    let shape = bounds.shape();
    let is_allowed = (1..=MAX_CONFIGURATIONS).contains(&shape[0]) && shape[1] == 2;
    if !is_allowed {
        let message = format!(
            "bounds have shape {shape:?}: must be (configurations, 2) with at most \
             {MAX_CONFIGURATIONS} configurations"
        );
        return Err(InputError::new_err(message));
    }
    let bounds = bounds.readonly();
    let rows = bounds.as_array();
    let rows = rows.rows().into_iter().map(|row| Bounds {
        min: row[0],
        max: row[1],
    });
    Ok(rows.collect())
}

/// Anytime-valid lower and upper bound of the mean of values within `lowest`..`highest`; each is wrong
/// with a probability of at most `alpha`.
#[pyfunction]
pub(crate) fn mean_bounds(
    py: Python,
    values: &Bound<PyArray1<f64>>,
    lowest: f64,
    highest: f64,
    alpha: f64,
) -> (f64, f64) {
    let bounds = Bounds {
        min: lowest,
        max: highest,
    };
    let values = values.readonly().as_array().to_vec();
    py.detach(|| bounds_of_mean(&values, bounds, alpha))
}

/// Anytime-valid lower and upper bound of the quantile of a share of ordered values; each is wrong with a
/// probability of at most `alpha`. A bound may be infinite.
#[pyfunction]
pub(crate) fn quantile_bounds(
    py: Python,
    ordered: &Bound<PyArray1<f64>>,
    share: f64,
    alpha: f64,
) -> (f64, f64) {
    let ordered = ordered.readonly().as_array().to_vec();
    py.detach(|| bounds_of_quantile(&ordered, share, alpha))
}

/// Whether the mean of values within `bounds` is proved to be above `candidate`; valid at any time. `true`
/// is wrong with a probability of at most `alpha`.
#[pyfunction]
pub(crate) fn mean_exceeds(
    py: Python,
    values: &Bound<PyArray1<f64>>,
    bounds: (f64, f64),
    candidate: f64,
    alpha: f64,
) -> bool {
    let values = values.readonly().as_array().to_vec();
    let (min, max) = bounds;
    py.detach(|| exceeds(&values, Bounds { min, max }, candidate, alpha))
}

/// The cheapest configuration that meets a requirement, and how precisely it is found.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct RequirementSearch(RequirementProblem);

#[pymethods]
impl RequirementSearch {
    /// `costs` has one number per configuration. With `finer`, a smaller tolerance, cheaper configurations
    /// that may meet the requirement are decided up to that.
    #[new]
    #[pyo3(signature = (costs, *, probability, tolerance, finer, confidence))]
    fn new(
        costs: &Bound<PyArray1<f64>>,
        probability: f64,
        tolerance: f64,
        finer: Option<f64>,
        confidence: f64,
    ) -> Self {
        Self(RequirementProblem {
            costs: costs.readonly().as_array().to_vec(),
            probability,
            tolerance,
            finer,
            confidence,
        })
    }

    /// A procedure without runs; `record` takes 1 for each run that meets the requirement, and 0 for each that
    /// does not.
    fn procedure(&self) -> Procedure {
        Procedure(Mutex::new(Box::new(Requirement::new(self.0.clone()))))
    }

    /// The number of runs, from `runs` on, after which a configuration is decided at the finer tolerance if
    /// `share` of them meet the requirement; at most 10^9.
    fn runs_to_decide(&self, share: f64, runs: u64) -> u64 {
        self.0.runs_to_decide(share, runs)
    }
}

/// Equal allocation: `runs` of each configuration, without a guarantee.
#[pyfunction]
pub(crate) fn equal_allocation(configurations: usize, runs: u32) -> Procedure {
    let procedure = EqualAllocation::new(configurations, runs.into());
    Procedure(Mutex::new(Box::new(procedure)))
}
