//! What happens in a run, for recordings.

use crate::economy::word;
use crate::metric_scenario::name_of;
use crate::simulation::Simulation;
use brain::AgentId;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use sim::judge::events::{Event, EventKind, EventReader as Reader, GoalName};
use sim::scenario::Scenario;

/// Reads the events of a run that happen after the reader was created.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct EventReader(Reader);

/// The step of an event, its kind, the name of what it happened to, and its value.
type EventTuple<'py> = (u64, &'static str, String, Bound<'py, PyAny>);

#[pymethods]
impl EventReader {
    #[new]
    fn new(py: Python, simulation: &Bound<Simulation>) -> PyResult<Self> {
        Ok(Self(simulation.get().locked(py)?.event_reader()))
    }

    /// Removes and returns the events since the last call, in their order. Each has the number of steps before its own,
    /// its kind, the name of an item, goal, robot or controller as it was then, and a value:
    ///
    /// | kind | name | value |
    /// |---|---|---|
    /// | detected | item | the time, and the robot |
    /// | served | goal | the robot |
    /// | acted | robot | what it did, the item there or None, the place, whether it succeeded |
    /// | destroyed | robot or vehicle | the item |
    /// | passed | vehicle | None |
    /// | collided | robot | its collisions so far |
    /// | status | robot | the number of its status |
    /// | issued, expired | goal | None |
    /// | unserved | goal | the reason |
    /// | awarded | goal | the controller, and the robot |
    /// | lost | goal | the controller |
    /// | failed | controller | None |
    /// | marked | controller | its number of the mark, and the verdict or None |
    /// | stated | controller | whether it has declared the lane clear, and the risk or None |
    /// | sent | sender | the content, the goal or None, and the receiver or None |
    fn drain<'py>(&self, py: Python<'py>) -> PyResult<Vec<EventTuple<'py>>> {
        let episodes = self.0.drain();
        let events = episodes
            .iter()
            .flat_map(|(scenario, events)| events.iter().map(move |event| (scenario, event)));
        events
            .map(|(scenario, event)| tuple(py, scenario, event))
            .collect()
    }
}

fn tuple<'py>(py: Python<'py>, scenario: &Scenario, event: &Event) -> PyResult<EventTuple<'py>> {
    let (kind, name, value) = parts(py, scenario, event)?;
    Ok((event.tick, kind, name, value))
}

/// The kind of an event, the name of what it happened to, and its value.
fn parts<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    event: &Event,
) -> PyResult<(&'static str, String, Bound<'py, PyAny>)> {
    let robot = |id| name_of(scenario, id);
    let item = |(kind, index): (u16, u32)| named(scenario.item_kinds(), kind.into(), index);
    let goal = |(kind, index): (u8, u32)| named(scenario.goal_kinds(), kind.into(), index);
    let any = |goal: GoalName| goal_name(scenario, goal);
    let none = || py.None().into_bound(py);
    Ok(match event.kind {
        EventKind::Detected { item: found, by } => {
            let value = (event.time_s(scenario), robot(by));
            ("detected", item(found), value.into_bound_py_any(py)?)
        }
        EventKind::Served { goal: served, by } => {
            ("served", goal(served), robot(by).into_bound_py_any(py)?)
        }
        EventKind::Acted {
            act,
            by,
            at,
            item: there,
            is_success,
        } => {
            let value = (act.name(), there.map(item), (at.x, at.y), is_success);
            ("acted", robot(by), value.into_bound_py_any(py)?)
        }
        EventKind::Destroyed {
            robot: lost,
            item: by,
        } => ("destroyed", robot(lost), item(by).into_bound_py_any(py)?),
        EventKind::VehicleLost { vehicle, item: by } => {
            let by = item(by).into_bound_py_any(py)?;
            ("destroyed", vehicle_name(vehicle), by)
        }
        EventKind::VehiclePassed { vehicle } => ("passed", vehicle_name(vehicle), none()),
        EventKind::Collided { robot: id, total } => {
            ("collided", robot(id), total.into_bound_py_any(py)?)
        }
        EventKind::Status { robot: id, status } => {
            ("status", robot(id), (status as u8).into_bound_py_any(py)?)
        }
        EventKind::Issued { goal: issued } => ("issued", goal(issued), none()),
        EventKind::Expired { goal: late } => ("expired", goal(late), none()),
        EventKind::Unserved {
            goal: stuck,
            reason,
        } => (
            "unserved",
            goal(stuck),
            word(&reason).into_bound_py_any(py)?,
        ),
        EventKind::Awarded { goal, by, to } => {
            let value = (robot(by), robot(to)).into_bound_py_any(py)?;
            ("awarded", any(goal), value)
        }
        EventKind::Lost { goal, by } => ("lost", any(goal), robot(by).into_bound_py_any(py)?),
        EventKind::Failed { controller } => ("failed", robot(controller), none()),
        EventKind::Marked {
            by,
            number,
            verdict,
        } => {
            let value = (number, verdict.as_ref().and_then(word));
            ("marked", robot(by), value.into_bound_py_any(py)?)
        }
        EventKind::Stated { by, is_clear, risk } => {
            let value = (is_clear, risk).into_bound_py_any(py)?;
            ("stated", robot(by), value)
        }
        EventKind::Sent {
            from,
            to,
            about,
            goal,
        } => {
            let to = to.agent().map(|to| receiver_name(scenario, to));
            let value = (about, goal.map(any), to).into_bound_py_any(py)?;
            ("sent", robot(from), value)
        }
    })
}

/// The name of a goal; of one that a controller has planned, its number and the controller.
fn goal_name(scenario: &Scenario, goal: GoalName) -> String {
    let GoalName { id, place } = goal;
    place.map_or_else(
        || {
            let issuer = id.issuer.agent().unwrap_or_default();
            format!("goal {} of {}", id.number, name_of(scenario, issuer))
        },
        |(kind, index)| named(scenario.goal_kinds(), kind.into(), index),
    )
}

/// The name of the receiver of a message.
fn receiver_name(scenario: &Scenario, id: AgentId) -> String {
    if id == AgentId::OPERATOR {
        return "operator".to_owned();
    }
    name_of(scenario, id)
}

/// The name of a vehicle that passes a lane.
pub(crate) fn vehicle_name(index: u32) -> String {
    format!("vehicle/{index}")
}

/// The name of an item or goal: KIND/INDEX.
fn named<'a>(mut kinds: impl Iterator<Item = &'a str>, kind: usize, index: u32) -> String {
    format!("{}/{index}", kinds.nth(kind).unwrap_or_default())
}
