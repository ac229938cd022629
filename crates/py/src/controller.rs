//! Controllers for other sources of percepts: another radio between them and brains, other simulators.

use crate::brain::read;
use crate::convert;
use crate::error::input_error;
use crate::metric_scenario::MetricScenario;
use crate::percept_check::of_controller;

use base::error::{InputError, InputErrors};
use brain::{AgentId, Command, Percept, Reason, Task};
use economy::{OwnedGoal, Settings};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::Serialize;
use std::sync::{Arc, Mutex, PoisonError};

/// A controller.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Controller {
    settings: Arc<Settings>,
    agent: Mutex<economy::Controller>,
}

/// A goal that it owns; `lease_s` is the remaining time of the robot's lease, `owner_lease_s` that of a majority of votes.
#[derive(Serialize)]
struct Owned {
    task: Task,
    assignee: Option<AgentId>,
    lease_s: Option<f64>,
    votes: Vec<AgentId>,
    owner_lease_s: Option<f64>,
    unserved: Option<Reason>,
}

#[pymethods]
impl Controller {
    /// A controller from a dict of its settings.
    #[new]
    fn new(settings: &Bound<PyAny>) -> PyResult<Self> {
        let mut errors = Vec::new();
        let read = read::<Settings>("settings", settings, &mut errors)?;
        errors.extend(read.as_ref().and_then(|read| short_lease(read, settings)));
        let read = InputErrors::or(errors, read).map_err(|errors| input_error(&errors, ""))?;
        Ok(Self::at_start(Arc::new(read)))
    }

    /// A controller of a kind in a scenario.
    #[staticmethod]
    fn of(scenario: &Bound<MetricScenario>, kind: &str) -> PyResult<Self> {
        let scenario = &scenario.get().0;
        let kinds: Vec<&str> = scenario.controller_kinds().collect();
        let number = kinds.iter().position(|known| *known == kind);
        let number = number.ok_or_else(|| {
            let given = Some(format!("{kind:?}"));
            let error = InputError::not_one_of("kind".to_owned(), given, kind, kinds.into_iter());
            input_error(&InputErrors(vec![error]), "")
        })?;
        let settings = scenario.controller_settings(number);
        let settings = settings.ok_or_else(|| PyRuntimeError::new_err("a kind has no settings"))?;
        Ok(Self::at_start(Arc::clone(settings)))
    }

    /// The command for a percept; both are dicts.
    fn step<'py>(&self, percept: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let read = convert::read("percept", percept);
        let read = read.and_then(|read| of_controller("percept", read));
        let read: Percept = read.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let mut command = Command::default();
        self.with(|controller| controller.step_into(&read, &mut command));
        convert::write(percept.py(), &command)
    }

    /// The goals that it owns and that are not done.
    fn goals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let goals: Vec<Owned> = self.with(|controller| controller.goals().map(as_owned).collect());
        convert::write(py, &goals)
    }

    /// The goals that it owned until its lease ended.
    fn lost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lost: Vec<Task> = self.with(|controller| controller.lost().collect());
        convert::write(py, &lost)
    }

    /// Number of goals that it refused.
    #[getter]
    fn refused(&self) -> u32 {
        self.with(|controller| controller.refused())
    }

    /// The controller after a restart: with the same settings, and no memory.
    fn restarted(&self) -> Self {
        let agent = economy::Controller::restarted(Arc::clone(&self.settings));
        Self {
            settings: Arc::clone(&self.settings),
            agent: Mutex::new(agent),
        }
    }

    /// An independent copy in the same state.
    fn copy(&self) -> Self {
        Self {
            settings: Arc::clone(&self.settings),
            agent: Mutex::new(self.with(|controller| controller.clone())),
        }
    }
}

impl Controller {
    fn at_start(settings: Arc<Settings>) -> Self {
        let agent = Mutex::new(economy::Controller::new(Arc::clone(&settings)));
        Self { settings, agent }
    }

    fn with<T>(&self, act: impl FnOnce(&mut economy::Controller) -> T) -> T {
        act(&mut self.agent.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The error of a service lease that ends before its auction; `given` are the settings as they were given.
fn short_lease(settings: &Settings, given: &Bound<PyAny>) -> Option<InputError> {
    let (lease_s, min_s) = (settings.service_lease_s, settings.min_service_lease_s(0.0));
    let is_given = given.contains("service_lease_s").unwrap_or(false);
    let default = if is_given { "" } else { " (default)" };
    let allowed = format!(
        "at least {min_s:.3}: it must outlast an auction of {} s",
        settings.auction_s
    );
    (lease_s < min_s).then(|| {
        let value = Some(format!("{lease_s}{default}"));
        InputError::new("settings.service_lease_s".to_owned(), value, allowed)
    })
}

fn as_owned(goal: OwnedGoal) -> Owned {
    Owned {
        task: goal.task,
        assignee: goal.assignee.map(|(robot, _)| robot),
        lease_s: goal.assignee.map(|(_, lease_s)| lease_s),
        votes: goal.votes,
        owner_lease_s: goal.owner_lease_s,
        unserved: goal.unserved,
    }
}

/// The column of each row in the assignment with the most pairs and, among those, the smallest sum of costs; None for a
/// row without a column. A cost that is not finite forbids its pair.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned array")]
pub(crate) fn assignment(costs: PyReadonlyArray2<f64>) -> Vec<Option<usize>> {
    let costs = costs.as_array();
    let by_rows: Vec<f64> = costs.iter().copied().collect();
    economy::assignment([costs.nrows(), costs.ncols()], &by_rows)
}
