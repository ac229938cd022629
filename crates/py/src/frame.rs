//! Frames of a run for display.

use crate::simulation::Simulation;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sim::run::{Robot, Status};
use sim::simulation::Simulation as Run;

/// The current step of a run for display, in little endian: four 32-bit floats per robot, then one byte per
/// item.
///
/// The floats of a robot are x and y in metres, its heading in radians, and its display state: 0 clear, 1
/// close to a collision, 2 stopped by a contact, 3 empty, 4 broken. The byte of an item is 0 if it has not
/// been found, 1 if it has, 2 if it was missed because the run is over, and 3 if it was destroyed.
#[pyfunction]
pub(crate) fn frame<'py>(
    py: Python<'py>,
    simulation: &Bound<'py, Simulation>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mut locked = simulation.get().locked(py)?;
    let run: &mut Run = &mut locked;
    let bytes = py.detach(|| drawn(run));
    Ok(PyBytes::new(py, &bytes))
}

fn drawn(run: &mut Run) -> Vec<u8> {
    let collision_warnings = run.collision_warnings();
    let (state, scenario) = (run.state(), run.scenario());
    let robots = state.each_robot(scenario).zip(collision_warnings);
    let mut bytes = Vec::with_capacity(16 * state.robots());
    for (robot, is_warned) in robots {
        #[expect(clippy::cast_possible_truncation, reason = "for display")]
        let [x, y, heading] = [robot.at.x, robot.at.y, robot.heading_rad].map(|it| it as f32);
        for number in [x, y, heading, display_state(&robot, is_warned)] {
            bytes.extend(number.to_le_bytes());
        }
    }
    let is_over = state.is_over(scenario);
    bytes.extend(state.each_item(scenario).map(|item| match item.found_s {
        _ if item.is_destroyed => 3,
        Some(_) => 1,
        None if is_over => 2,
        None => 0,
    }));
    bytes
}

fn display_state(robot: &Robot, is_warned: bool) -> f32 {
    match robot.status {
        Status::Broken => 4.0,
        Status::Empty => 3.0,
        Status::Active if robot.is_touching => 2.0,
        Status::Active if is_warned => 1.0,
        Status::Active => 0.0,
    }
}
