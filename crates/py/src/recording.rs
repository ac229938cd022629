//! The state of a run as recordings store it.

use crate::convert;
use crate::simulation::Simulation;
use base::map::OccupancyMap;
use base::trig::sin_cos;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use sim::bodies::Layer;
use sim::run::Robot;
use sim::scenario::Scenario;
use sim::world::obstacles::Solid;

/// The state at the current step; arrays have one entry per robot.
///
/// `tick`, `hash`, `decisions` (their hash, None if they are not hashed), `poses` (`x_m`, `y_m`, `heading_rad`), `half_turns` (sine and cosine of half the
/// heading, the same on every machine), `speeds`, `commanded` (`speed_m_s`, `turn_rate_rad_s`),
/// `status`, `battery` and `collisions` as `Simulation` has them; `found_s` has one entry per item.
#[pyfunction]
pub(crate) fn recorded_moment<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyDict>> {
    let run = simulation.get().locked(py)?;
    let robots: Vec<Robot> = run.state().each_robot(run.scenario()).collect();
    let dict = PyDict::new(py);
    dict.set_item("tick", run.state().tick())?;
    dict.set_item("hash", run.hash())?;
    dict.set_item("decisions", run.state().decision_hash())?;
    dict.set_item("poses", rows(py, &robots, pose)?)?;
    dict.set_item("half_turns", rows(py, &robots, half_turn)?)?;
    dict.set_item("commanded", rows(py, &robots, commanded)?)?;
    dict.set_item("speeds", each(py, &robots, |robot| robot.speed_m_s))?;
    dict.set_item("status", each(py, &robots, |robot| robot.status as u8))?;
    dict.set_item(
        "battery",
        each(py, &robots, |robot| robot.battery.unwrap_or(1.0)),
    )?;
    dict.set_item("collisions", each(py, &robots, |robot| robot.collisions))?;
    let items = run.state().each_item(run.scenario());
    let found: Vec<f64> = items.map(|item| item.found_s.unwrap_or(f64::NAN)).collect();
    dict.set_item("found_s", found.into_pyarray(py))?;
    Ok(dict)
}

fn pose(robot: &Robot) -> [f64; 3] {
    [robot.at.x, robot.at.y, robot.heading_rad]
}

fn half_turn(robot: &Robot) -> [f64; 2] {
    sin_cos(robot.heading_rad / 2.0).into()
}

fn commanded(robot: &Robot) -> [f64; 2] {
    [robot.setpoint.speed_m_s, robot.setpoint.turn_rate_rad_s]
}

fn each<'py, T: numpy::Element>(
    py: Python<'py>,
    robots: &[Robot],
    of: impl Fn(&Robot) -> T,
) -> Bound<'py, numpy::PyArray1<T>> {
    robots.iter().map(of).collect::<Vec<T>>().into_pyarray(py)
}

fn rows<'py, const N: usize>(
    py: Python<'py>,
    robots: &[Robot],
    of: impl Fn(&Robot) -> [f64; N],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows: Vec<[f64; N]> = robots.iter().map(of).collect();
    rows.into_flattened()
        .into_pyarray(py)
        .reshape([robots.len(), N])
}

/// The part of the state that only changes with the scenario: `radius_m` and `is_flying` of each robot;
/// `bodies` (as brains know them), `radio_m` (range of the radio) and `flies` by kind; `shapes`, the
/// obstacles other than maps, with all copies, in their order: `number` among all obstacles, `entry`, the index in `world.obstacles`,
/// and either `polygon_m`, its corners anticlockwise, or `at_m` and `radius_m`; and `maps`, the others, in their order:
/// `corners_m` anticlockwise from the origin, `resolution_m`, and `occupancy`, shape (rows, columns), the
/// lowest row first.
#[pyfunction]
pub(crate) fn recorded_setting<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyDict>> {
    let run = simulation.get().locked(py)?;
    let robots: Vec<Robot> = run.state().each_robot(run.scenario()).collect();
    let shapes = run
        .scenario()
        .obstacles()
        .enumerate()
        .filter_map(|(number, (entry, solid))| shape_dict(py, [number, entry], solid).transpose());
    let maps = run
        .scenario()
        .solids()
        .iter()
        .filter_map(|solid| match solid {
            Solid::Map(map) => Some(map_dict(py, map)),
            _ => None,
        });
    let dict = PyDict::new(py);
    dict.set_item("radius_m", each(py, &robots, |robot| robot.radius_m))?;
    dict.set_item(
        "is_flying",
        each(py, &robots, |robot| robot.layer == Layer::Air),
    )?;
    dict.set_item("bodies", bodies(py, run.scenario())?)?;
    let radios = (0..).zip(run.scenario().robot_kinds());
    let radios = radios.map(|(number, kind)| (kind, run.scenario().radio_m(number)));
    dict.set_item("radio_m", radios.into_py_dict(py)?)?;
    let layers = (0..).zip(run.scenario().robot_kinds());
    let flies = layers.map(|(number, kind)| {
        let layer = run.scenario().layer(number);
        (kind, layer == Some(Layer::Air))
    });
    dict.set_item("flies", flies.into_py_dict(py)?)?;
    dict.set_item("shapes", shapes.collect::<PyResult<Vec<_>>>()?)?;
    dict.set_item("maps", maps.collect::<PyResult<Vec<_>>>()?)?;
    Ok(dict)
}

fn bodies<'py>(py: Python<'py>, scenario: &Scenario) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (number, kind) in (0..).zip(scenario.robot_kinds()) {
        if let Some(brain) = scenario.brain(number) {
            dict.set_item(kind, convert::write(py, brain.body())?)?;
        }
    }
    Ok(dict)
}

/// None for a map.
fn shape_dict<'py>(
    py: Python<'py>,
    [number, entry]: [usize; 2],
    solid: &Solid,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let dict = PyDict::new(py);
    dict.set_item("number", number)?;
    dict.set_item("entry", entry)?;
    match solid {
        Solid::Polygon(polygon) => {
            let corners = polygon.edges().map(|edge| (edge.from.x, edge.from.y));
            let mut corners: Vec<(f64, f64)> = corners.collect();
            corners.reverse();
            dict.set_item("polygon_m", corners)?;
        }
        Solid::Disc(disc) => {
            dict.set_item("at_m", (disc.centre.x, disc.centre.y))?;
            dict.set_item("radius_m", disc.radius_m)?;
        }
        Solid::Map(_) => return Ok(None),
    }
    Ok(Some(dict))
}

fn map_dict<'py>(py: Python<'py>, map: &OccupancyMap) -> PyResult<Bound<'py, PyDict>> {
    let (columns, rows) = (map.columns(), map.rows());
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let cells = places.map(|(column, row)| map.occupancy(column, row).unwrap_or(-1));
    let cells: Vec<i8> = cells.collect();
    let shape = [rows as usize, columns as usize];
    let dict = PyDict::new(py);
    dict.set_item(
        "corners_m",
        map.corners().map(|corner| (corner.x, corner.y)).to_vec(),
    )?;
    dict.set_item("resolution_m", map.resolution_m())?;
    dict.set_item("occupancy", cells.into_pyarray(py).reshape(shape)?)?;
    Ok(dict)
}
