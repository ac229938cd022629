//! Scenarios of the metric engine, and the robots and kinds in them by name.

use crate::convert;
use crate::error::input_error;
use crate::scenario::Source;
use base::error::{InputError, InputErrors, nearest};
use brain::AgentId;
use pyo3::prelude::*;
use sim::scenario::{Scenario, ScenarioSpec};
use std::sync::Arc;

/// A scenario of the metric engine, ready to run.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct MetricScenario(pub(crate) Arc<Scenario>);

/// Reads the parts of a source that a run depends on.
#[pyfunction]
pub(crate) fn read_metric(source: Source) -> PyResult<MetricScenario> {
    let file = source.file.clone();
    let read = ScenarioSpec::read(&source.document()?);
    let checked = read.map_err(|errors| input_error(&errors, &file))?;
    Ok(MetricScenario(Arc::new(checked.scenario)))
}

/// The name of a robot or controller: KIND/INDEX.
pub(crate) fn name_of(scenario: &Scenario, id: AgentId) -> String {
    let mut kinds = scenario.robot_kinds().chain(scenario.controller_kinds());
    let kind = kinds.nth(id.kind.into());
    format!("{}/{}", kind.unwrap_or_default(), id.index)
}

/// The robot of a name; `path` is the path of errors.
pub(crate) fn robot_of(scenario: &Scenario, path: &str, name: &str) -> Result<AgentId, InputError> {
    id_in(&scenario.team(), "robots", path, name)
}

/// The robot or controller of a name; `path` is the path of errors.
pub(crate) fn participant_of(
    scenario: &Scenario,
    path: &str,
    name: &str,
) -> Result<AgentId, InputError> {
    let mut all = scenario.team();
    let robots = all.len();
    all.extend(scenario.controller_team());
    let what = if all.len() > robots {
        "robots and controllers"
    } else {
        "robots"
    };
    let id = id_in(&all, what, path, name)?;
    let is_robot = usize::from(id.kind) < robots;
    Ok(if is_robot {
        id
    } else {
        AgentId::controller(id.kind, id.index)
    })
}

/// The id of a name among kinds, in the order of their numbers, with their counts; `what` they are, in errors.
fn id_in(
    team: &[(String, u32)],
    what: &str,
    path: &str,
    name: &str,
) -> Result<AgentId, InputError> {
    let (kind, index) = name.rsplit_once('/').unwrap_or((name, ""));
    let place = team.iter().position(|(known, _)| known == kind);
    let id = place.zip(index.parse().ok()).and_then(|(place, index)| {
        let is_there = index < team[place].1 && name == format!("{kind}/{index}");
        let kind = u8::try_from(place).ok()?;
        is_there.then_some(AgentId::robot(kind, index))
    });
    id.ok_or_else(|| unknown(team, what, path, name))
}

fn unknown(team: &[(String, u32)], what: &str, path: &str, name: &str) -> InputError {
    let there = team.iter().filter(|(_, count)| *count > 0);
    let (kind, index) = name.rsplit_once('/').unwrap_or((name, "0"));
    let kinds = there.clone().map(|(kind, _)| kind.as_str());
    let suggestion = nearest(kind, kinds).map(|near| match index.parse::<u32>() {
        Ok(index)
            if there
                .clone()
                .any(|(kind, count)| kind == near && index < *count) =>
        {
            format!("{near}/{index}")
        }
        _ => format!("{near}/0"),
    });
    let names = there.map(|(kind, count)| match count {
        1 => format!("{kind}/0"),
        _ => format!("{kind}/0 to {kind}/{}", count - 1),
    });
    let names: Vec<String> = names.collect();
    let allowed = format!("one of the run's {what}: {}", names.join(", "));
    InputError {
        suggestion,
        ..InputError::new(path.to_owned(), Some(format!("{name:?}")), allowed)
    }
}

/// The robot that a Python string names.
pub(crate) fn id_of(scenario: &Scenario, robot: &Bound<PyAny>) -> PyResult<AgentId> {
    let id = robot_of(scenario, "robot", &convert::text(robot));
    id.map_err(|error| input_error(&InputErrors(vec![error]), ""))
}

/// The index of a robot kind; `path` is the path of errors.
pub(crate) fn kind_of(scenario: &Scenario, path: &str, kind: &str) -> Result<u8, InputError> {
    among(scenario.robot_kinds().collect(), path, kind)
}

/// The index of a kind of robots or controllers, which are numbered after robots; `path` is the path of errors.
pub(crate) fn participant_kind(
    scenario: &Scenario,
    path: &str,
    kind: &str,
) -> Result<u8, InputError> {
    let kinds = scenario.robot_kinds().chain(scenario.controller_kinds());
    among(kinds.collect(), path, kind)
}

fn among(kinds: Vec<&str>, path: &str, kind: &str) -> Result<u8, InputError> {
    let place = kinds.iter().position(|known| *known == kind);
    let number = place.and_then(|place| u8::try_from(place).ok());
    number.ok_or_else(|| {
        let given = Some(format!("{kind:?}"));
        InputError::not_one_of(path.to_owned(), given, kind, kinds.into_iter())
    })
}

/// The body of a robot kind as its brain knows it, or the settings of a kind of controllers; `path` is the path of
/// errors.
#[pyfunction]
pub(crate) fn body<'py>(
    scenario: &Bound<'py, MetricScenario>,
    path: &str,
    kind: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let py = scenario.py();
    let scenario = &scenario.get().0;
    let number = participant_kind(scenario, path, kind);
    let number = number.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
    let place = usize::from(number).checked_sub(scenario.team().len());
    match place.and_then(|place| scenario.controller_settings(place)) {
        Some(settings) => convert::write(py, &**settings),
        None => convert::write(py, &scenario.brain(number).map(brain::Brain::body)),
    }
}
