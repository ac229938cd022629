//! The goals and controllers of a run.

use crate::metric_scenario::{id_of, name_of};
use crate::simulation::Simulation;
use brain::GoalId;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;
use sim::run::{Controller, Goal};
use sim::scenario::Scenario;

type NumberOf = fn(&Goal) -> f64;

/// The numbers of a goal, by name; NaN for a time of what has not happened.
const NUMBERS: [(&str, NumberOf); 9] = [
    ("x_m", |goal| goal.at.x),
    ("y_m", |goal| goal.at.y),
    ("issued_s", |goal| goal.issued_s.unwrap_or(f64::NAN)),
    ("awarded_s", |goal| goal.awarded_s.unwrap_or(f64::NAN)),
    ("pursued_s", |goal| goal.pursued_s.unwrap_or(f64::NAN)),
    ("began_s", |goal| goal.began_s.unwrap_or(f64::NAN)),
    ("arrived_s", |goal| goal.arrived_s.unwrap_or(f64::NAN)),
    ("served_s", |goal| goal.served_s.unwrap_or(f64::NAN)),
    ("blocked_s", |goal| goal.blocked_s.unwrap_or(f64::NAN)),
];

/// The goals of a run, by column: `name` (KIND/INDEX), `issuer` and `number` of the id, the numbers above, `served_by`,
/// `served_twice`, `expired`, `unserved` and `status`. The robot of a goal that was not served is empty, and so is `unserved` of
/// one that no controller reported.
#[pyfunction]
pub(crate) fn goals<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyDict>> {
    let run = simulation.get().locked(py)?;
    let scenario = run.scenario();
    let goals: Vec<Goal> = run.state().each_goal(scenario).collect();
    let each = |of: &dyn Fn(&Goal) -> String| goals.iter().map(of).collect::<Vec<_>>();
    let dict = PyDict::new(py);
    dict.set_item("name", each(&|goal| goal_name(scenario, goal)))?;
    let issuers = goals.iter().map(|goal| goal.id.issuer.number());
    dict.set_item("issuer", issuers.collect::<Vec<_>>().into_pyarray(py))?;
    let numbers = goals.iter().map(|goal| goal.id.number);
    dict.set_item("number", numbers.collect::<Vec<_>>().into_pyarray(py))?;
    for (name, number) in NUMBERS {
        let numbers: Vec<f64> = goals.iter().map(number).collect();
        dict.set_item(name, numbers.into_pyarray(py))?;
    }
    let robots = goals.iter().map(|goal| goal.served_by);
    let robots = robots.map(|id| id.map_or_else(String::new, |id| name_of(scenario, id)));
    dict.set_item("served_by", robots.collect::<Vec<_>>())?;
    let flags = |of: fn(&Goal) -> bool| {
        let flags: Vec<bool> = goals.iter().map(of).collect();
        flags.into_pyarray(py)
    };
    dict.set_item("served_twice", flags(|goal| goal.is_served_twice))?;
    dict.set_item("expired", flags(|goal| goal.has_expired))?;
    let reasons = goals
        .iter()
        .map(|goal| goal.unserved.as_ref().and_then(word))
        .map(Option::unwrap_or_default);
    dict.set_item("unserved", reasons.collect::<Vec<_>>())?;
    let statuses = goals.iter().map(|goal| goal.status.name());
    dict.set_item("status", statuses.collect::<Vec<_>>())?;
    Ok(dict)
}

/// The controllers of a run, each as a dict with its `name` (KIND/INDEX), `x_m`, `y_m`, `aboard`, `range_m`, `working`,
/// `transfers`, `refused`, the `goals` that it owns as far as it knows, and `lost`.
#[pyfunction]
pub(crate) fn controllers<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyList>> {
    let run = simulation.get().locked(py)?;
    let goals: Vec<Goal> = run.state().each_goal(run.scenario()).collect();
    let controllers = run.state().each_controller();
    let dicts = controllers.map(|controller| dict_of(py, run.scenario(), &controller, &goals));
    PyList::new(py, dicts.collect::<PyResult<Vec<_>>>()?)
}

/// The goals of controllers that a robot serves, in its order, each as a dict with `goal` (its name; None if it is not
/// of the scenario), `x_m`, `y_m`, `owner`, `lease_s` and `verdict`.
#[pyfunction]
pub(crate) fn served_goals<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyList>> {
    let run = simulation.get().locked(py)?;
    let scenario = run.scenario();
    let id = id_of(scenario, robot)?;
    let goals: Vec<Goal> = run.state().each_goal(scenario).collect();
    let served = run.state().served_goals(id);
    let dicts = served.iter().map(|served| {
        let dict = PyDict::new(py);
        dict.set_item("goal", name_of_goal(scenario, served.task.id, &goals))?;
        let [x_m, y_m] = served.task.at_m;
        dict.set_item("x_m", x_m)?;
        dict.set_item("y_m", y_m)?;
        dict.set_item("owner", name_of(scenario, served.owner))?;
        dict.set_item("lease_s", served.lease_s)?;
        dict.set_item("verdict", word(&served.verdict))?;
        Ok(dict)
    });
    PyList::new(py, dicts.collect::<PyResult<Vec<_>>>()?)
}

fn dict_of<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    controller: &Controller,
    goals: &[Goal],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", name_of(scenario, controller.id))?;
    dict.set_item("x_m", controller.at.x)?;
    dict.set_item("y_m", controller.at.y)?;
    let aboard = controller.aboard.map(|id| name_of(scenario, id));
    dict.set_item("aboard", aboard)?;
    dict.set_item("range_m", controller.range_m)?;
    dict.set_item("working", controller.is_working)?;
    dict.set_item("transfers", controller.transfers)?;
    dict.set_item("refused", controller.refused)?;
    let owned = controller.goals.iter().map(|owned| {
        let dict = PyDict::new(py);
        dict.set_item("goal", name_of_goal(scenario, owned.task.id, goals))?;
        let [x_m, y_m] = owned.task.at_m;
        dict.set_item("x_m", x_m)?;
        dict.set_item("y_m", y_m)?;
        let assignee = owned.assignee.map(|(id, _)| name_of(scenario, id));
        dict.set_item("assignee", assignee)?;
        dict.set_item("lease_s", owned.assignee.map(|(_, lease_s)| lease_s))?;
        dict.set_item("unserved", owned.unserved.as_ref().and_then(word))?;
        let votes = owned.votes.iter().map(|id| name_of(scenario, *id));
        dict.set_item("votes", votes.collect::<Vec<_>>())?;
        dict.set_item("owner_lease_s", owned.owner_lease_s)?;
        Ok(dict)
    });
    dict.set_item("goals", owned.collect::<PyResult<Vec<_>>>()?)?;
    let lost = controller.lost.iter();
    let lost = lost.map(|task| name_of_goal(scenario, task.id, goals));
    dict.set_item("lost", lost.collect::<Vec<_>>())?;
    Ok(dict)
}

/// The word for a reason for which no robot can serve a goal, or for a verdict.
pub(crate) fn word(value: &impl Serialize) -> Option<String> {
    let word = serde_json::to_value(value).ok()?;
    word.as_str().map(str::to_owned)
}

/// The name of the goal of an id; `None` if it is not of the scenario.
fn name_of_goal(scenario: &Scenario, id: GoalId, goals: &[Goal]) -> Option<String> {
    let goal = goals.iter().find(|goal| goal.id == id);
    goal.map(|goal| goal_name(scenario, goal))
}

/// The name of a goal: KIND/INDEX.
fn goal_name(scenario: &Scenario, goal: &Goal) -> String {
    let kind = scenario.goal_kinds().nth(goal.kind.into());
    format!("{}/{}", kind.unwrap_or_default(), goal.index)
}
