//! Stepwise runs of the classic engine.

use crate::arguments::Arguments;
use crate::configuration::{ColumnTuple, as_tuple};
use crate::error::input_error;
use crate::long_work::interruptible;
use crate::scenario::Source;
use crate::snapshot::Measured;
use base::engine::Runner;
use classic::world::{CELL_PX, ITEMS, SIZE, cells};
use classic::{Colour, Configuration, Robot, Run};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{PyBytes, PyDict};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Robot-steps that take some milliseconds: too short to start a thread for.
const SHORT: u64 = 4096;

/// A scenario of the classic engine, ready to run.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct ClassicScenario(Configuration);

/// Reads the parts of a source that a run depends on.
#[pyfunction]
pub(crate) fn read_classic(source: Source) -> PyResult<ClassicScenario> {
    let file = source.file.clone();
    let read = Configuration::read(&source.document()?);
    read.map(ClassicScenario)
        .map_err(|errors| input_error(&errors, &file))
}

/// The world: cells per side, pixels per cell, and lists of cells (columns to the right, rows down) of
/// its walls and its items.
#[pyfunction]
pub(crate) fn classic_world(py: Python) -> PyResult<Bound<PyDict>> {
    let walls = cells().filter(|cell| cell.is_static() && !ITEMS.contains(cell));
    let dict = PyDict::new(py);
    dict.set_item("size", SIZE)?;
    dict.set_item("cell_px", CELL_PX)?;
    dict.set_item(
        "walls",
        walls.map(|cell| (cell.x, cell.y)).collect::<Vec<_>>(),
    )?;
    dict.set_item("items", ITEMS.map(|cell| (cell.x, cell.y)))?;
    Ok(dict)
}

/// A copy of a run at one step.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct ClassicSnapshot(Measured<Run>);

#[pymethods]
impl ClassicSnapshot {
    /// Memory that it takes, in bytes.
    #[getter]
    fn bytes(&self) -> u64 {
        self.0.bytes
    }
}

/// A run. It may be shared between threads, which wait for each other.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct ClassicSimulation(Mutex<Run>);

#[pymethods]
impl ClassicSimulation {
    #[new]
    #[pyo3(signature = (scenario, *, seed, run))]
    fn new(
        scenario: &Bound<ClassicScenario>,
        seed: &Bound<PyAny>,
        run: &Bound<PyAny>,
    ) -> PyResult<Self> {
        let check = Arguments::default();
        let (seed, run) = (check.seed(seed), check.run("run", run));
        let (seed, run) = check.or_errors(seed.zip(run))?;
        Ok(Self(Mutex::new(Run::new(scenario.get().0, seed, run))))
    }

    /// Advances by `steps` paints, or until the run is over. Ctrl-C stops it between two paints.
    fn step(&self, py: Python, steps: &Bound<PyAny>) -> PyResult<()> {
        let check = Arguments::default();
        let steps = check.integer("steps", steps, 0..=u64::MAX);
        let steps = check.or_errors(steps)?;
        let robots = u64::from(self.locked(py).configuration().robots);
        let go = |stop: &AtomicBool| {
            let mut run = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let end = run.paint().saturating_add(steps);
            while run.paint() < end && !run.search().is_over() && !stop.load(Ordering::Relaxed) {
                run.step();
            }
        };
        if steps.saturating_mul(robots) <= SHORT {
            py.detach(|| go(&AtomicBool::new(false)));
            return Ok(());
        }
        interruptible(py, None, go)
    }

    /// Continues with another scenario; returns the number of steps taken.
    fn change(&self, py: Python, scenario: &Bound<ClassicScenario>) -> u64 {
        let mut run = self.locked(py);
        run.change(scenario.get().0);
        run.paint()
    }

    fn snapshot(&self, py: Python) -> ClassicSnapshot {
        ClassicSnapshot(Measured::of(&*self.locked(py)))
    }

    fn restore(&self, py: Python, snapshot: &Bound<ClassicSnapshot>) {
        *self.locked(py) = snapshot.get().0.run.clone();
    }

    /// The outcome at the current step, by column; at the end of the run, it is that of `run_one`.
    fn outcome<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let locked = self.locked(py);
        let run: &Run = &locked;
        // The final outcome of a run that is over may take more steps to compute.
        let values = py.detach(|| run.values());
        let dict = PyDict::new(py);
        for (column, value) in run.configuration().columns().iter().zip(values) {
            dict.set_item(&*column.name, value)?;
        }
        Ok(dict)
    }

    /// Items found, and a number that differs when anything else was counted since.
    #[getter]
    fn counts(&self, py: Python) -> (u64, u64) {
        self.locked(py).search().counts()
    }

    /// The outcome columns: see `Configuration.columns`.
    #[getter]
    fn columns(&self, py: Python) -> Vec<ColumnTuple> {
        let columns = self.locked(py).configuration().columns();
        columns.iter().map(as_tuple).collect()
    }

    /// Number of paints.
    #[getter]
    fn tick(&self, py: Python) -> u64 {
        self.locked(py).paint()
    }

    #[getter]
    fn step_s(&self, py: Python) -> f64 {
        self.locked(py).seconds(1)
    }

    #[getter]
    fn time_s(&self, py: Python) -> f64 {
        let run = self.locked(py);
        run.seconds(run.paint())
    }

    #[getter]
    fn is_over(&self, py: Python) -> bool {
        self.locked(py).search().is_over()
    }

    #[getter]
    fn hash(&self, py: Python) -> u64 {
        self.locked(py).search().hash()
    }

    /// The left-slow score that the last robot to decide passes to the next one.
    #[getter]
    fn carry(&self, py: Python) -> i16 {
        self.locked(py).search().simulation().carry()
    }

    /// Number of paints until the next decision.
    #[getter]
    fn decides_in(&self, py: Python) -> u64 {
        self.locked(py).search().simulation().decides_in()
    }

    /// The time at which each item was found, in seconds; None if it has not been found.
    #[getter]
    fn found_s(&self, py: Python) -> Vec<Option<f64>> {
        self.locked(py).found_s().to_vec()
    }

    /// For each robot, `x_px` and `y_px` (right and down), the `column` and `row` of its cell, `heading_deg`
    /// (clockwise from up), `speed` (cells per decision), `left_turns`, `right_turns` and `colour` (0 blue, 1 yellow, 2 red).
    #[getter]
    fn robots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let run = self.locked(py);
        let robots = run.search().simulation().robots().iter();
        let dict = PyDict::new(py);
        dict.set_item(
            "x_px",
            robots.clone().map(|robot| robot.x_px).collect::<Vec<_>>(),
        )?;
        dict.set_item(
            "y_px",
            robots.clone().map(|robot| robot.y_px).collect::<Vec<_>>(),
        )?;
        let whole = |name: &str, of: fn(&Robot) -> i64| {
            dict.set_item(name, robots.clone().map(of).collect::<Vec<_>>())
        };
        whole("column", |robot| robot.cell().x.into())?;
        whole("row", |robot| robot.cell().y.into())?;
        whole("heading_deg", |robot| robot.heading.degrees().into())?;
        whole("speed", |robot| robot.speed.number().into())?;
        whole("left_turns", |robot| robot.left_turns.into())?;
        whole("right_turns", |robot| robot.right_turns.into())?;
        whole("colour", |robot| look(robot.colour).into())?;
        Ok(dict)
    }

    /// For each item, the cells (columns and rows) on which a robot can find it.
    #[getter]
    fn contacts(&self, py: Python) -> Vec<Vec<(i32, i32)>> {
        let contact = self.locked(py).configuration().task.contact;
        let cells = ITEMS.map(|item| contact.cells(item));
        let cells = cells
            .into_iter()
            .map(|cells| cells.into_iter().map(|cell| (cell.x, cell.y)));
        cells.map(Iterator::collect).collect()
    }

    /// The cells (columns and rows) that a robot would examine in a decision now.
    fn examined_cells(&self, py: Python, robot: usize) -> Vec<(i32, i32)> {
        let run = self.locked(py);
        let robot = run.search().simulation().robots().get(robot);
        let cells = robot.into_iter().flat_map(Robot::looks);
        cells.map(|cell| (cell.x, cell.y)).collect()
    }

    /// The current step for display, in the layout of [`crate::frame::frame`], in pixels with y upwards.
    fn frame<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &drawn(&self.locked(py)))
    }
}

impl ClassicSimulation {
    /// The run, after waiting for other threads without holding the interpreter.
    fn locked(&self, py: Python) -> MutexGuard<'_, Run> {
        let locked = self.0.lock_py_attached(py);
        locked.unwrap_or_else(PoisonError::into_inner)
    }
}

#[expect(clippy::cast_precision_loss, reason = "25 cells")]
const WINDOW_PX: f32 = SIZE as f32 * CELL_PX;

fn drawn(run: &Run) -> Vec<u8> {
    let robots = run.search().simulation().robots();
    let mut bytes = Vec::with_capacity(16 * robots.len() + ITEMS.len());
    for robot in robots {
        let heading_rad = (90.0 - f32::from(robot.heading.degrees())).to_radians();
        let up_px = WINDOW_PX - robot.y_px;
        for number in [robot.x_px, up_px, heading_rad, look(robot.colour).into()] {
            bytes.extend(number.to_le_bytes());
        }
    }
    let is_over = run.search().is_over();
    bytes.extend(run.search().found_at().map(|found_at| match found_at {
        Some(_) => 1,
        None if is_over => 2,
        None => 0,
    }));
    bytes
}

fn look(colour: Colour) -> u8 {
    match colour {
        Colour::Blue => 0,
        Colour::Yellow => 1,
        Colour::Red => 2,
    }
}
