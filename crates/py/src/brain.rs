//! Brains for other sources of percepts: real robots, other simulators, learning.

use crate::convert::{self, below};
use crate::error::input_error;
use crate::metric_scenario::{MetricScenario, kind_of};
use crate::percept_check::fitting;
use crate::scenario::value_without_none;
use crate::serde_error::as_in_python;

use base::document::Document;
use base::document::schema::Schema;
use base::error::{InputError, InputErrors};
use brain::{AssignedGoal, BeliefState, Body, BrainSpec, Command, Percept, ServedGoal};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use schemars::{JsonSchema, schema_for};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Brains ignore positions farther from the origin.
const MAX_COORDINATE_M: f64 = 1e7;

/// The brain of a robot.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Brain(Mutex<brain::Brain>);

#[pymethods]
impl Brain {
    /// A brain from a dict like `[robots.KIND.brain]` of a scenario, for a body, also a dict.
    #[new]
    fn new(spec: &Bound<PyAny>, body: &Bound<PyAny>) -> PyResult<Self> {
        let mut errors = Vec::new();
        let spec = read::<BrainSpec>("brain", spec, &mut errors)?;
        let body = read::<Body>("body", body, &mut errors)?;
        errors.extend(body.as_ref().and_then(field_too_large));
        let both = spec.zip(body);
        let (spec, body) =
            InputErrors::or(errors, both).map_err(|errors| input_error(&errors, ""))?;
        let brain = brain::Brain::new(Arc::new(spec), Arc::new(body));
        Ok(Self(Mutex::new(brain)))
    }

    /// The brain of the robots of a kind in a scenario.
    #[staticmethod]
    fn of(scenario: &Bound<MetricScenario>, kind: &str) -> PyResult<Self> {
        let scenario = &scenario.get().0;
        let number = kind_of(scenario, "kind", kind);
        let number = number.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let brain = scenario.brain(number);
        let brain = brain.ok_or_else(|| PyRuntimeError::new_err("a kind has no brain"))?;
        Ok(Self(Mutex::new(brain.clone())))
    }

    /// The command for a percept; both are dicts.
    fn step<'py>(&self, percept: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let read = convert::read("percept", percept);
        let fitting = |read| self.with(|brain| fitting("percept", read, brain.body()));
        let read = read.and_then(fitting);
        let read: Percept = read.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let command = self.with(|brain| brain.step(&read));
        convert::write(percept.py(), &command)
    }

    /// Its beliefs and goals; None if it has no beliefs.
    fn belief_state<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let belief_state = self.with(|brain| brain.belief_state());
        belief_state
            .map(|belief_state| convert::write(py, &belief_state))
            .transpose()
    }

    /// The goals that a person has assigned, in the order of assignment.
    fn assigned_goals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::write(py, &self.with(|brain| brain.assigned_goals()))
    }

    /// The goals of controllers that it serves, in the order in which it serves them.
    fn served_goals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::write(py, &self.with(|brain| brain.served_goals()))
    }

    /// An independent copy in the same state.
    fn copy(&self) -> Self {
        Self(Mutex::new(self.with(|brain| brain.clone())))
    }

    /// The JSON Schemas of the specification, inputs and outputs of a brain, and of its belief state, by
    /// name.
    #[staticmethod]
    fn schemas(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let schemas = [
            ("BrainSpec", schema_for!(BrainSpec)),
            ("Body", schema_for!(Body)),
            ("Percept", schema_for!(Percept)),
            ("Command", schema_for!(Command)),
            ("BeliefState", schema_for!(BeliefState)),
            ("AssignedGoal", schema_for!(AssignedGoal)),
            ("ServedGoal", schema_for!(ServedGoal)),
        ];
        convert::write(py, &schemas.into_iter().collect::<BTreeMap<_, _>>())
    }
}

impl Brain {
    fn with<T>(&self, act: impl FnOnce(&mut brain::Brain) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// An error, if the brain's maps could not cover the mission area of a body.
fn field_too_large(body: &Body) -> Option<InputError> {
    let field = body.field?;
    let farthest_m = [field.min(), field.max()]
        .map(|corner| corner.x.abs().max(corner.y.abs()))
        .into_iter()
        .fold(0.0, f64::max);
    let allowed = format!("coordinates within {MAX_COORDINATE_M:e} m of the origin");
    let given = Some(format!("{farthest_m:e}"));
    (farthest_m > MAX_COORDINATE_M)
        .then(|| InputError::new("body.field".to_owned(), given, allowed))
}

/// Reads a dict that is checked like a document; None counts as missing. `name` is its path in errors.
pub(crate) fn read<T: DeserializeOwned + JsonSchema>(
    name: &str,
    given: &Bound<PyAny>,
    errors: &mut Vec<InputError>,
) -> PyResult<Option<T>> {
    let read = checked(name, given)?;
    let wrong = read.as_ref().err().into_iter().flatten();
    errors.extend(wrong.map(|error| InputError {
        allowed: as_in_python(&error.allowed),
        ..error.clone()
    }));
    Ok(read.ok())
}

/// The same, with errors in the terms of documents.
pub(crate) fn checked<T: DeserializeOwned + JsonSchema>(
    name: &str,
    given: &Bound<PyAny>,
) -> PyResult<Result<T, Vec<InputError>>> {
    let mut document = Document::default();
    let value = value_without_none(&[name.to_owned()], given, name)?;
    document.set(&[], value, "");
    let read = document.typed(&Schema::of::<T>());
    let named = |error: InputError| InputError {
        origin: None,
        path: below(name, &error.path),
        ..error
    };
    Ok(read.map_err(|errors| errors.0.into_iter().map(named).collect()))
}
