//! The mined lane of a run.

use crate::economy::word;
use crate::events::vehicle_name;
use crate::metric_scenario::name_of;
use crate::simulation::Simulation;
use economy::{BelievedMark, ClearedShare, PlannedPassage};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sim::passage::{Vehicle, VehicleStatus};
use sim::run::BelievedLane;
use sim::scenario::Scenario;

/// Number of mines in the lane that are not destroyed; 0 without a lane.
#[pyfunction]
pub(crate) fn mines_left(py: Python<'_>, simulation: &Bound<'_, Simulation>) -> PyResult<u32> {
    let run = simulation.get().locked(py)?;
    Ok(run.state().mines_left(run.scenario()))
}

/// The vehicles that pass the lane, in their order, each as a dict with its `name`, `x_m`, `y_m`, `has_entered` and
/// `status`.
#[pyfunction]
pub(crate) fn vehicles<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyList>> {
    let run = simulation.get().locked(py)?;
    let vehicles = run.state().each_vehicle();
    let dicts = vehicles.map(|vehicle| vehicle_of(py, vehicle));
    PyList::new(py, dicts.collect::<PyResult<Vec<_>>>()?)
}

fn vehicle_of(py: Python<'_>, vehicle: Vehicle) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", vehicle_name(vehicle.index))?;
    dict.set_item("x_m", vehicle.at.x)?;
    dict.set_item("y_m", vehicle.at.y)?;
    dict.set_item("has_entered", vehicle.has_entered)?;
    let status = match vehicle.status {
        VehicleStatus::Driving => "driving",
        VehicleStatus::Passed => "passed",
        VehicleStatus::Lost => "lost",
    };
    dict.set_item("status", status)?;
    Ok(dict)
}

/// What each controller believes of the lane, each as a dict with the name of the `controller`, `corners_m`, `cell_m`,
/// `unmarked` and `expected` of shape (rows, columns), `marks`, `risk`, `declare_below`, `cleared_below_per_m2`,
/// `statement`, `clearance` and `passage`.
#[pyfunction]
pub(crate) fn lanes<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyList>> {
    let run = simulation.get().locked(py)?;
    let lanes = run.state().each_lane();
    let dicts = lanes.map(|lane| dict_of(py, run.scenario(), lane));
    PyList::new(py, dicts.collect::<PyResult<Vec<_>>>()?)
}

fn dict_of<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    lane: BelievedLane,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("controller", name_of(scenario, lane.controller))?;
    let area = lane.lane.area();
    let corners = [area.min(), area.max()].map(|corner| (corner.x, corner.y));
    dict.set_item("corners_m", corners.to_vec())?;
    dict.set_item("cell_m", f64::from(lane.lane.cell_m))?;
    let [columns, rows] = lane.lane.columns_and_rows();
    let cells = |values: Vec<f64>| values.into_pyarray(py).reshape([rows, columns]);
    dict.set_item("expected", cells(lane.expected())?)?;
    dict.set_item("cleared_below_per_m2", lane.cleared_below_per_m2())?;
    dict.set_item("declare_below", lane.declare_below)?;
    dict.set_item("risk", risk_of(py, &lane)?)?;
    let marks = lane.marks.iter().map(|mark| mark_of(py, scenario, mark));
    dict.set_item("marks", marks.collect::<PyResult<Vec<_>>>()?)?;
    dict.set_item("statement", statement_of(py, &lane)?)?;
    dict.set_item("unmarked", cells(lane.unmarked)?)?;
    let cleared = lane.cleared.iter();
    let cleared = cleared.map(|share| cleared_of(py, scenario, share));
    dict.set_item("clearance", cleared.collect::<PyResult<Vec<_>>>()?)?;
    let passage = lane.passage.as_ref();
    let passage = passage.map(|passage| passage_of(py, passage));
    dict.set_item("passage", passage.transpose()?)?;
    Ok(dict)
}

fn cleared_of<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    of: &ClearedShare,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kind", scenario.item_kinds().nth(of.kind))?;
    dict.set_item("cleared", of.cleared)?;
    dict.set_item("left", of.left)?;
    dict.set_item("share", of.share)?;
    dict.set_item("low", of.low)?;
    dict.set_item("high", of.high)?;
    Ok(dict)
}

fn passage_of<'py>(py: Python<'py>, passage: &PlannedPassage) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let path: Vec<(f64, f64)> = passage.path.iter().map(|at| (at.x, at.y)).collect();
    dict.set_item("path_m", path)?;
    dict.set_item("width_m", passage.width_m)?;
    dict.set_item("length_m", passage.length_m)?;
    dict.set_item("mines", passage.mines)?;
    dict.set_item("risks", passage.risks.clone())?;
    Ok(dict)
}

fn risk_of<'py>(py: Python<'py>, lane: &BelievedLane) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("unmarked", lane.risk.unmarked)?;
    dict.set_item("marked", lane.risk.marked)?;
    dict.set_item("probability", lane.risk.probability)?;
    Ok(dict)
}

fn mark_of<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    mark: &BelievedMark,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("number", mark.number)?;
    dict.set_item("x_m", mark.at.x)?;
    dict.set_item("y_m", mark.at.y)?;
    dict.set_item("deviation_m", mark.deviation_m)?;
    let probabilities = PyDict::new(py);
    for (kind, probability) in scenario.item_kinds().zip(mark.probabilities) {
        probabilities.set_item(kind, probability)?;
    }
    dict.set_item("probabilities", probabilities)?;
    dict.set_item("mine", mark.mine)?;
    dict.set_item("verdict", mark.verdict.as_ref().and_then(word))?;
    dict.set_item("failed_charges", mark.failed_charges)?;
    Ok(dict)
}

fn statement_of<'py>(py: Python<'py>, lane: &BelievedLane) -> PyResult<Option<Bound<'py, PyDict>>> {
    let statement = lane.statement.map(|statement| {
        let dict = PyDict::new(py);
        dict.set_item("is_clear", statement.is_clear)?;
        dict.set_item("risk", statement.risk)?;
        dict.set_item("at_s", statement.at_s)?;
        Ok(dict)
    });
    statement.transpose()
}
