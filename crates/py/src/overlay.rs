//! Radio links and sensor footprints of a run for display.

use crate::metric_scenario::id_of;
use crate::simulation::Simulation;
use brain::AgentId;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use sim::simulation::{Footprint, Link, Sensors, Simulation as Run};
use std::iter;

/// The radio links of a robot, or of all, shape (links, 3): the numbers of sender and receiver, and 1 if
/// the link works both ways, else 0.
#[pyfunction]
pub(crate) fn links<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    let robot = robot
        .map(|robot| id_of(run.scenario(), &robot))
        .transpose()?;
    let links = py.detach(|| run.links(robot, usize::MAX));
    let links = links.unwrap_or_default();
    rows(&links).into_pyarray(py).reshape([links.len(), 3])
}

/// The footprints of a robot's sensors, by sensor name: bearings in radians, and the visible distance along
/// each in metres.
#[pyfunction]
pub(crate) fn footprints<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    robot: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    let id = id_of(run.scenario(), robot)?;
    let footprints = py
        .detach(|| run.footprints(id, Sensors::All))
        .unwrap_or_default();
    let body = run.scenario().brain(id.kind).map(brain::Brain::body);
    let dict = PyDict::new(py);
    for footprint in footprints {
        let bearings_rad = footprint.bearings_rad().into_pyarray(py);
        let name = body.map(|body| body.sensors[footprint.sensor].as_str());
        dict.set_item(name, (bearings_rad, footprint.ranges_m.into_pyarray(py)))?;
    }
    Ok(dict)
}

/// Up to `limit` links for display, each as three little-endian 32-bit numbers as in [`links`]: with
/// `all_robots` those of all robots, otherwise those of the `selected` one, if it exists. Links of the
/// selected robot are never omitted.
#[pyfunction]
pub(crate) fn drawn_links<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    selected: Option<Bound<'py, PyAny>>,
    all_robots: bool,
    limit: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    let selected = selected.and_then(|robot| id_of(run.scenario(), &robot).ok());
    let links = py.detach(|| to_draw(run, selected, all_robots, limit));
    let numbers = rows(&links).into_iter();
    let bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
    Ok(PyBytes::new(py, &bytes))
}

fn to_draw(run: &mut Run, selected: Option<AgentId>, all_robots: bool, limit: usize) -> Vec<Link> {
    let mut of = |robot| run.links(robot, limit).unwrap_or_default();
    let mut links = match selected {
        _ if all_robots => of(None),
        Some(id) => of(Some(id)),
        None => Vec::new(),
    };
    if all_robots && selected.is_some() && links.len() == limit {
        let own = of(selected);
        links.retain(|link| !own.contains(link));
        links.splice(..0, own);
        links.truncate(limit);
    }
    // Pages draw links between robots only.
    let robots = run.state().robots();
    links.retain(|link| (link.from.max(link.to) as usize) < robots);
    links
}

fn rows(links: &[Link]) -> Vec<u32> {
    let row = |link: &Link| [link.from, link.to, u32::from(link.is_mutual)];
    links.iter().flat_map(row).collect()
}

/// Footprints for display, in little endian: all sensors of the `selected` robot, if it exists, and with
/// `all_robots` the item detectors of the other robots.
///
/// Each starts with four 32-bit numbers: the number of the robot, 1 if the sensor detects items or else 0,
/// the number of corners, and the range in metres as a float. Two floats per corner follow: its bearing
/// from the robot's front in radians, and its distance in metres, see [`Footprint::corners`].
#[pyfunction]
pub(crate) fn drawn_footprints<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
    selected: Option<Bound<'py, PyAny>>,
    all_robots: bool,
) -> PyResult<Bound<'py, PyBytes>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    let selected = selected.and_then(|robot| id_of(run.scenario(), &robot).ok());
    let bytes = py.detach(|| drawn(run, selected, all_robots));
    Ok(PyBytes::new(py, &bytes))
}

fn drawn(run: &mut Run, selected: Option<AgentId>, all_robots: bool) -> Vec<u8> {
    let robots = run.state().each_robot(run.scenario());
    let ids = (0..).zip(robots.map(|robot| robot.id));
    let ids: Vec<(u32, AgentId)> = ids
        .filter(|(_, id)| all_robots || selected == Some(*id))
        .collect();
    let mut bytes = Vec::new();
    for (number, id) in ids {
        let of = if selected == Some(id) {
            Sensors::All
        } else {
            Sensors::Items
        };
        for footprint in run.footprints(id, of).unwrap_or_default() {
            draw(number, &footprint, &mut bytes);
        }
    }
    bytes
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "for display; a maximum of 361 corners"
)]
fn draw(robot: u32, footprint: &Footprint, bytes: &mut Vec<u8>) {
    let corners = footprint.corners();
    for number in [
        robot,
        u32::from(footprint.finds_items),
        corners.len() as u32,
    ] {
        bytes.extend(number.to_le_bytes());
    }
    let floats = iter::once(&footprint.range_m).chain(corners.as_flattened());
    for number in floats {
        bytes.extend((*number as f32).to_le_bytes());
    }
}
