//! What happens in a run, for recordings.

use crate::metric_scenario::name_of;
use crate::simulation::Simulation;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use sim::judge::events::{Event, EventKind, EventReader as Reader};
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
    /// its kind, the name of an item, goal or robot as it was then, and a value: of "detected" the time, of "served" the name
    /// of the robot, of "acted" what it did, the item there or None, the place and whether it succeeded, of
    /// "destroyed" the item that destroyed the robot or vehicle, of "passed" None, of "collided" the robot's collisions so far, and of "status" the number of its status.
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
    let tick = event.tick;
    Ok(match event.kind {
        EventKind::Detected { item, .. } => {
            let name = named(scenario.item_kinds(), item.0.into(), item.1);
            (
                tick,
                "detected",
                name,
                event.time_s(scenario).into_bound_py_any(py)?,
            )
        }
        EventKind::Served { goal, by } => {
            let name = named(scenario.goal_kinds(), goal.0.into(), goal.1);
            let by = name_of(scenario, by);
            (tick, "served", name, by.into_bound_py_any(py)?)
        }
        EventKind::Acted {
            act,
            by,
            at,
            item,
            is_success,
        } => {
            let item = item.map(|(kind, index)| named(scenario.item_kinds(), kind.into(), index));
            let value = (act.name(), item, (at.x, at.y), is_success);
            let value = value.into_bound_py_any(py)?;
            (tick, "acted", name_of(scenario, by), value)
        }
        EventKind::Destroyed { robot, item } => {
            let item = named(scenario.item_kinds(), item.0.into(), item.1);
            let name = name_of(scenario, robot);
            (tick, "destroyed", name, item.into_bound_py_any(py)?)
        }
        EventKind::VehicleLost { vehicle, item } => {
            let item = named(scenario.item_kinds(), item.0.into(), item.1);
            (
                tick,
                "destroyed",
                vehicle_name(vehicle),
                item.into_bound_py_any(py)?,
            )
        }
        EventKind::VehiclePassed { vehicle } => (
            tick,
            "passed",
            vehicle_name(vehicle),
            py.None().into_bound(py),
        ),
        EventKind::Collided { robot, total } => {
            let name = name_of(scenario, robot);
            (tick, "collided", name, total.into_bound_py_any(py)?)
        }
        EventKind::Status { robot, status } => {
            let name = name_of(scenario, robot);
            (tick, "status", name, (status as u8).into_bound_py_any(py)?)
        }
    })
}

/// The name of a vehicle that passes a lane.
pub(crate) fn vehicle_name(index: u32) -> String {
    format!("vehicle/{index}")
}

/// The name of an item or goal: KIND/INDEX.
fn named<'a>(mut kinds: impl Iterator<Item = &'a str>, kind: usize, index: u32) -> String {
    format!("{}/{index}", kinds.nth(kind).unwrap_or_default())
}
