//! Inspection of one robot of a run: its percepts, decisions and beliefs.

use crate::convert;
use crate::metric_scenario::id_of;
use crate::simulation::Simulation;
use brain::BelievedMap;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sim::simulation::{Inspected, Simulation as Run};

/// Selects a robot for inspection from now on; `None` selects none.
#[pyfunction]
pub(crate) fn inspect<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: Option<Bound<'py, PyAny>>,
) -> PyResult<()> {
    let mut run = simulation.get().locked(py)?;
    let robot = robot.map(|robot| id_of(run.scenario(), &robot));
    run.inspect(robot.transpose()?);
    Ok(())
}

/// The percept and the decision of a robot's brain in the next step, with the reasons. Selects the robot
/// for inspection. `None` if its brain has not stepped since then, or the robot no longer exists.
#[pyfunction]
pub(crate) fn inspection<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: &Bound<'py, PyAny>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    // A change of the run may have given it another number.
    run.inspect(id_of(run.scenario(), robot).ok());
    let Some(inspected) = py.detach(|| run.inspection()) else {
        return Ok(None);
    };
    let Inspected {
        tick,
        percept,
        decision,
        ..
    } = inspected;
    let dict = PyDict::new(py);
    dict.set_item("tick", tick)?;
    dict.set_item("percept", convert::write(py, &percept)?)?;
    dict.set_item("command", convert::write(py, &decision.command)?)?;
    dict.set_item("leading", decision.leading)?;
    dict.set_item("holds_s", decision.holds_s)?;
    dict.set_item("belief_state", convert::write(py, &decision.belief_state)?)?;
    Ok(Some(dict))
}

/// The map that a robot believes; `None` if it has none.
#[pyfunction]
pub(crate) fn believed_map<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: &Bound<'py, PyAny>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let run = simulation.get().locked(py)?;
    let map = run.state().map(id_of(run.scenario(), robot)?);
    map.map(|map| as_dict(py, map)).transpose()
}

fn as_dict(py: Python, map: BelievedMap) -> PyResult<Bound<PyDict>> {
    let shape = [map.rows, map.columns];
    let dict = PyDict::new(py);
    dict.set_item("corner", (map.corner.x, map.corner.y))?;
    dict.set_item("cell_m", map.cell_m)?;
    dict.set_item("occupancy", map.occupancy.into_pyarray(py).reshape(shape)?)?;
    dict.set_item("unseen", map.unseen.into_pyarray(py).reshape(shape)?)?;
    Ok(dict)
}
