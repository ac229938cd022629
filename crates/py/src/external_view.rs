//! External bodies for display, and what fleets need to know of sensors.

use crate::metric_scenario::name_of;
use crate::simulation::Simulation;
use base::geometry::Point;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sim::simulation::Detected;

/// What fleets need to know of each kind of sensor, by name: whether it states where the robot is, whether
/// it is a ring of rays, and whether its real and virtual readings can be merged.
#[pyfunction]
pub(crate) fn sensor_kinds(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let kinds = PyDict::new(py);
    for facts in sim::sensors::KINDS {
        let kind = PyDict::new(py);
        kind.set_item("states_pose", facts.states_pose())?;
        kind.set_item("is_ring", facts.is_ring)?;
        kind.set_item("can_be_both", facts.can_be_both())?;
        kinds.set_item(facts.name, kind)?;
    }
    Ok(kinds)
}

/// The external bodies of a run, for display: where they may be, and what their sensors report.
#[pyfunction]
pub(crate) fn external_views<'py>(
    py: Python<'py>,
    run: &Bound<'py, Simulation>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let run = run.get().locked(py)?;
    let points = |points: &[Point]| -> Vec<(f64, f64)> {
        points.iter().map(|point| (point.x, point.y)).collect()
    };
    let detected = |detected: &Detected| {
        let dict = PyDict::new(py);
        dict.set_item("echoes_m", points(&detected.echoes))?;
        dict.set_item("contacts_m", points(&detected.contacts))?;
        dict.set_item("neighbours_m", points(&detected.neighbours))?;
        PyResult::Ok(dict)
    };
    let views = run.external_views();
    let views = views.iter().map(|view| {
        let dict = PyDict::new(py);
        dict.set_item("robot", name_of(run.scenario(), view.id))?;
        dict.set_item("at_m", (view.at.x, view.at.y))?;
        dict.set_item("radius_m", view.radius_m)?;
        dict.set_item("uncertainty_m", view.uncertainty_m)?;
        dict.set_item("silent_s", view.silent_s)?;
        dict.set_item("outline_m", points(&view.outline))?;
        dict.set_item("real", detected(&view.real)?)?;
        dict.set_item("virtual", detected(&view.measured)?)?;
        Ok(dict)
    });
    views.collect()
}
