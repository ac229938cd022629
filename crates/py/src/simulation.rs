//! Stepwise runs of the metric engine.

use crate::arguments::Arguments;
use crate::configuration::{ColumnTuple, as_tuple};
use crate::convert;
use crate::error::{input_error, no_room_error};
use crate::external;
use crate::long_work::interruptible;
use crate::metric_scenario::{MetricScenario, id_of, name_of, participant_of, robot_of};
use crate::python_brain::{self, PythonBrain};
use crate::snapshot::Measured;
use base::engine::Runner;
use base::error::{InputError, InputErrors};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sim::run::{Item as RunItem, NoRoom, Robot};
use sim::runner::Runs;
use sim::scenario::Scenario;
use sim::simulation::Simulation as Run;
use sim::step::ExternalInputs;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, ThreadId};
use std::time::Duration;

/// Robot-steps that take some milliseconds: too short to start a thread for.
const SHORT: u64 = 1024;

/// Time between two checks whether another thread has finished.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// A copy of a run at one step.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Snapshot(Measured<Run>);

#[pymethods]
impl Snapshot {
    /// Memory that it takes, in bytes, besides what it shares with the run.
    #[getter]
    fn bytes(&self) -> u64 {
        self.0.bytes
    }
}

/// A run. It may be shared between threads, which wait for each other.
#[pyclass(frozen, module = "agent_economy._core")]
pub(crate) struct Simulation {
    run: Mutex<Run>,
    threads: Option<usize>,
    /// The thread in which Python brains are running.
    brain_thread: Mutex<Option<ThreadId>>,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scenario, *, seed, run, threads, external))]
    #[expect(clippy::too_many_arguments, reason = "PyO3 passes the interpreter too")]
    fn new(
        py: Python,
        scenario: &Bound<MetricScenario>,
        seed: &Bound<PyAny>,
        run: &Bound<PyAny>,
        threads: &Bound<PyAny>,
        external: &Bound<PyDict>,
    ) -> PyResult<Self> {
        let check = Arguments::default();
        let (seed, run, threads) = (
            check.seed(seed),
            check.run("run", run),
            check.threads(threads),
        );
        let scenario = &scenario.get().0;
        let all = (|| Some((seed?, run?, threads?)))();
        let (seed, run, threads) = check.or_errors(all)?;
        let external = external::bodies(scenario, external);
        let external = external.map_err(|errors| input_error(&errors, ""))?;
        let begun = py.detach(|| Run::new(Arc::clone(scenario), seed, run));
        let begun = begun.map_err(|why| no_room(scenario, why))?;
        let begun = begun.with_external(external);
        let begun = begun.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self {
            run: Mutex::new(begun),
            threads,
            brain_thread: Mutex::new(None),
        })
    }

    /// Advances by `steps`, also after the run is over. Ctrl-C stops it between two steps.
    fn step(&self, py: Python, steps: &Bound<PyAny>) -> PyResult<()> {
        let check = Arguments::default();
        let steps = check.integer("steps", steps, 0..=u64::MAX);
        let steps = check.or_errors(steps)?;
        let mut run = self.locked(py)?;
        let work = robots(&run).max(1).saturating_mul(steps);
        let steps = 0..steps;
        self.advance(py, &mut run, work, |run, stop| {
            for _ in steps.take_while(|_| !stop.load(Ordering::Relaxed)) {
                run.step();
            }
        })
    }

    /// Advances until the run is over. Ctrl-C stops it between two steps.
    fn finish(&self, py: Python) -> PyResult<()> {
        let mut run = self.locked(py)?;
        self.advance(py, &mut run, u64::MAX, |run, stop| {
            while !stop.load(Ordering::Relaxed) && !run.state().is_over(run.scenario()) {
                run.step();
            }
        })
    }

    /// Advances by one step with the percepts of external bodies and with commands for other robots, as
    /// dicts by robot name, and with Python `brains` for some kinds. Returns the commands for external
    /// bodies. If a brain raises, the run does not advance.
    #[expect(clippy::needless_pass_by_value, reason = "PyO3 passes an owned list")]
    fn step_with<'py>(
        &self,
        py: Python<'py>,
        inputs: [Bound<'py, PyDict>; 3],
        brains: Vec<PythonBrain<'py>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut run = self.locked(py)?;
        let kinds = brains.iter().filter_map(|brain| brain.kind(run.scenario()));
        let kinds: Vec<u8> = kinds.collect();
        let read = external::read(&run, &inputs, &kinds);
        let inputs = read.map_err(|errors| input_error(&errors, ""))?;
        let work = robots(&run);
        let begun = self.advance(py, &mut run, work, |run, _| run.begin_step(inputs, &kinds))?;
        let mut begun = begun.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        self.run_brains(run.scenario(), &brains, &mut begun)?;
        let answers = self.advance(py, &mut run, work, |run, _| run.finish_step(begun))?;
        external::write(py, run.scenario(), &answers)
    }

    /// The commands of Python brains in the last step, by robot.
    #[getter]
    fn decided<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let run = self.locked(py)?;
        let decided = run.decided().iter();
        let decided = decided
            .map(|decision| (decision.robot, &decision.command))
            .collect();
        external::write(py, run.scenario(), &decided)
    }

    /// The last percept of a robot with an external body, with what the run added; None before the first.
    fn perceived<'py>(
        &self,
        py: Python<'py>,
        robot: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let run = self.locked(py)?;
        let id = robot_of(run.scenario(), "robot", &convert::text(robot));
        let id = id.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let perceived = run.perceived(id);
        let perceived = perceived.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        perceived
            .map(|perceived| convert::write(py, &perceived.whole))
            .transpose()
    }

    /// The percept of a robot or controller in the next step; None if it does not run in that step.
    fn percept<'py>(
        &self,
        py: Python<'py>,
        robot: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let mut run = self.locked(py)?;
        let id = participant_of(run.scenario(), "robot", &convert::text(robot));
        let id = id.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let work = robots(&run);
        let percept = self.advance(py, &mut run, work, |run, _| run.percept(id))?;
        let percept = percept.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        percept
            .map(|percept| convert::write(py, &percept))
            .transpose()
    }

    /// The path of the scenario's key that lists the failed robots or controllers of a kind, and the index of one of
    /// them, by its name.
    fn failure(&self, py: Python, name: &str) -> PyResult<(String, u32)> {
        let run = self.locked(py)?;
        let scenario = run.scenario();
        let id = participant_of(scenario, "name", name);
        let id = id.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let mut robots = run.state().each_robot(scenario);
        if robots.any(|robot| robot.id == id && robot.is_external) {
            let allowed = "a robot whose body is simulated: an external body does not fail here";
            let given = Some(format!("{name:?}"));
            let error = InputError::new("name".to_owned(), given, allowed.to_owned());
            return Err(input_error(&InputErrors(vec![error]), ""));
        }
        let group = if id.is_robot() {
            "robots"
        } else {
            "controllers"
        };
        let kind = name.rsplit_once('/').map_or(name, |(kind, _)| kind);
        Ok((format!("{group}.{kind}.failed"), id.index))
    }

    /// The path of the scenario's key that lists the robots of a kind that are out of service, and the index of one
    /// of them, by its name.
    fn service(&self, py: Python, name: &str) -> PyResult<(String, u32)> {
        let run = self.locked(py)?;
        let scenario = run.scenario();
        let id = participant_of(scenario, "name", name);
        let id = id.and_then(|id| {
            let allowed = "a robot: a controller is always in service".to_owned();
            let given = Some(format!("{name:?}"));
            let error = InputError::new("name".to_owned(), given, allowed);
            Some(id).filter(|id| id.is_robot()).ok_or(error)
        });
        let id = id.map_err(|error| input_error(&InputErrors(vec![error]), ""))?;
        let kind = name.rsplit_once('/').map_or(name, |(kind, _)| kind);
        Ok((format!("robots.{kind}.out_of_service"), id.index))
    }

    /// The beliefs and goals of a robot; None if its brain has no beliefs.
    fn belief_state<'py>(
        &self,
        py: Python<'py>,
        robot: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let run = self.locked(py)?;
        let belief_state = run.state().belief_state(id_of(run.scenario(), robot)?);
        belief_state
            .map(|belief_state| convert::write(py, &belief_state))
            .transpose()
    }

    /// The goals that a person has assigned to a robot, in the order of assignment.
    fn assigned_goals<'py>(
        &self,
        py: Python<'py>,
        robot: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let run = self.locked(py)?;
        let robot = id_of(run.scenario(), robot)?;
        convert::write(py, &run.state().assigned_goals(robot))
    }

    /// The outcome at the current step, by column; None if it is not finite.
    fn outcome<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let run = self.locked(py)?;
        let runs = Runs(Arc::clone(run.scenario()));
        let Some(values) = runs.values(&run.outcome()) else {
            return Ok(None);
        };
        let dict = PyDict::new(py);
        for (column, value) in runs.columns().iter().zip(values) {
            dict.set_item(&*column.name, value)?;
        }
        Ok(Some(dict))
    }

    /// Items found, and a number that differs when anything else was counted since.
    #[getter]
    fn counts(&self, py: Python) -> PyResult<(u64, u64)> {
        Ok(self.locked(py)?.state().counts())
    }

    /// The outcome columns: see `Configuration.columns`.
    #[getter]
    fn columns(&self, py: Python) -> PyResult<Vec<ColumnTuple>> {
        let runs = Runs(Arc::clone(self.locked(py)?.scenario()));
        Ok(runs.columns().iter().map(as_tuple).collect())
    }

    /// Continues with another scenario; returns the number of steps taken. After Ctrl-C, the run is
    /// unchanged.
    fn change(&self, py: Python, scenario: &Bound<MetricScenario>) -> PyResult<u64> {
        let mut run = self.locked(py)?;
        let to = &scenario.get().0;
        let mut errors = unchangeable(run.scenario(), to);
        errors.extend(run.state().without_effect(run.scenario(), to));
        InputErrors::or(errors, Some(())).map_err(|errors| input_error(&errors, ""))?;
        let work = robots(&run).saturating_add(to.robots() as u64);
        let changed = self.advance(py, &mut run, work, |run, _| {
            run.state().changed(run.scenario(), to)
        })?;
        // Only now: Ctrl-C must leave the run unchanged.
        run.continue_with(Arc::clone(to), changed.map_err(|why| no_room(to, why))?);
        Ok(run.state().tick())
    }

    fn snapshot(&self, py: Python) -> PyResult<Snapshot> {
        Ok(Snapshot(Measured::of(&*self.locked(py)?)))
    }

    fn restore(&self, py: Python, snapshot: &Bound<Snapshot>) -> PyResult<()> {
        let mut run = self.locked(py)?;
        let (inspected, scenario) = (run.inspected_robot(), Arc::clone(run.scenario()));
        run.return_to(snapshot.get().0.run.clone());
        // In another scenario, robots may have other numbers.
        let is_same = Arc::ptr_eq(&scenario, run.scenario());
        run.inspect(inspected.filter(|_| is_same));
        Ok(())
    }

    /// Number of steps taken.
    #[getter]
    fn tick(&self, py: Python) -> PyResult<u64> {
        Ok(self.locked(py)?.state().tick())
    }

    #[getter]
    fn step_s(&self, py: Python) -> PyResult<f64> {
        Ok(self.locked(py)?.scenario().step_s())
    }

    #[getter]
    fn time_s(&self, py: Python) -> PyResult<f64> {
        Ok(self.locked(py)?.time_s())
    }

    #[getter]
    fn is_over(&self, py: Python) -> PyResult<bool> {
        let run = self.locked(py)?;
        Ok(run.state().is_over(run.scenario()))
    }

    #[getter]
    fn hash(&self, py: Python) -> PyResult<u64> {
        Ok(self.locked(py)?.hash())
    }

    /// Hashes all decisions from now on, beginning with a value.
    fn hash_decisions(&self, py: Python, start: &Bound<PyAny>) -> PyResult<()> {
        let check = Arguments::default();
        let start = check.integer("start", start, 0..=u64::MAX);
        let start = check.or_errors(start)?;
        self.locked(py)?.hash_decisions(start);
        Ok(())
    }

    /// The hash of all decisions since then; None if they are not hashed.
    #[getter]
    fn decision_hash(&self, py: Python) -> PyResult<Option<u64>> {
        Ok(self.locked(py)?.state().decision_hash())
    }

    /// KIND/INDEX of each robot.
    #[getter]
    fn robots(&self, py: Python) -> PyResult<Vec<String>> {
        let run = self.locked(py)?;
        let robots = run.state().each_robot(run.scenario());
        Ok(robots
            .map(|robot| name_of(run.scenario(), robot.id))
            .collect())
    }

    /// `x_m`, `y_m` and `heading_rad` of each robot.
    #[getter]
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let poses = self.each(py, |robot| [robot.at.x, robot.at.y, robot.heading_rad])?;
        let shape = [poses.len(), 3];
        poses.into_flattened().into_pyarray(py).reshape(shape)
    }

    #[getter]
    fn speeds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.each(py, |robot| robot.speed_m_s)?.into_pyarray(py))
    }

    /// 0 active, 1 empty, 2 broken.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u8>>> {
        Ok(self.each(py, |robot| robot.status as u8)?.into_pyarray(py))
    }

    /// Whether the body of each robot is external.
    #[getter]
    fn external<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        Ok(self.each(py, |robot| robot.is_external)?.into_pyarray(py))
    }

    /// State of charge of each robot's battery, 0 to 1; 1 for a battery without a capacity.
    #[getter]
    fn battery<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let left = self.each(py, |robot| robot.battery.unwrap_or(1.0))?;
        Ok(left.into_pyarray(py))
    }

    /// `kind`, `x_m`, `y_m`, `found_s` and `found_by` of each item; NaN and "" if it has not been found.
    #[getter]
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let run = self.locked(py)?;
        let names: Vec<&str> = run.scenario().item_kinds().collect();
        let items: Vec<_> = run.state().each_item(run.scenario()).collect();
        let kinds = items.iter().map(|item| names[usize::from(item.kind)]);
        let numbers = |number: fn(&RunItem) -> f64| {
            let numbers: Vec<f64> = items.iter().map(number).collect();
            numbers.into_pyarray(py)
        };
        let dict = PyDict::new(py);
        dict.set_item("kind", kinds.collect::<Vec<_>>())?;
        dict.set_item("x_m", numbers(|item| item.at.x))?;
        dict.set_item("y_m", numbers(|item| item.at.y))?;
        dict.set_item("found_s", numbers(|item| item.found_s.unwrap_or(f64::NAN)))?;
        let robots = items.iter().map(|item| item.found_by);
        let robots = robots.map(|id| id.map_or_else(String::new, |id| name_of(run.scenario(), id)));
        dict.set_item("found_by", robots.collect::<Vec<_>>())?;
        Ok(dict)
    }
}

impl Simulation {
    /// The run, after waiting for other threads. While waiting, it releases the interpreter, which they may
    /// need, and checks for Ctrl-C.
    pub(crate) fn locked(&self, py: Python) -> PyResult<MutexGuard<'_, Run>> {
        loop {
            match self.run.try_lock() {
                Ok(run) => return Ok(run),
                // A panic in another thread is reported there.
                Err(TryLockError::Poisoned(run)) => return Ok(run.into_inner()),
                Err(TryLockError::WouldBlock)
                    if *self.brain_thread() == Some(thread::current().id()) =>
                {
                    let sentence = "a brain must not access or step the run that it is part of: it \
                                    only knows its percept";
                    let error = InputError::new(String::new(), None, sentence.to_owned());
                    return Err(input_error(&InputErrors(vec![error]), ""));
                }
                Err(TryLockError::WouldBlock) => {
                    py.detach(|| thread::sleep(POLL_INTERVAL));
                    py.check_signals()?;
                }
            }
        }
    }

    /// Runs Python brains in this thread, the only one to which Python delivers Ctrl-C.
    fn run_brains(
        &self,
        scenario: &Scenario,
        brains: &[PythonBrain],
        begun: &mut ExternalInputs,
    ) -> PyResult<()> {
        *self.brain_thread() = Some(thread::current().id());
        let decided = python_brain::decide(scenario, brains, begun);
        *self.brain_thread() = None;
        decided
    }

    fn brain_thread(&self) -> MutexGuard<'_, Option<ThreadId>> {
        self.brain_thread
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Advances a run: in this thread for little `work` (robots times steps), otherwise on a thread pool,
    /// with checks for Ctrl-C.
    fn advance<T: Send>(
        &self,
        py: Python,
        run: &mut Run,
        work: u64,
        go: impl FnOnce(&mut Run, &AtomicBool) -> T + Send,
    ) -> PyResult<T> {
        if work <= SHORT {
            let stop = AtomicBool::new(false);
            return Ok(py.detach(|| go(run, &stop)));
        }
        interruptible(py, self.threads, |stop| go(run, stop))
    }

    /// A value of each robot, in order.
    fn each<T>(&self, py: Python, of: impl Fn(&Robot) -> T) -> PyResult<Vec<T>> {
        let run = self.locked(py)?;
        let robots = run.state().each_robot(run.scenario());
        Ok(robots.map(|robot| of(&robot)).collect())
    }
}

fn robots(run: &Run) -> u64 {
    run.state().robots() as u64
}

/// The changes that a run does not allow: its times are counted in steps, and all positions lie within its
/// world.
fn unchangeable(from: &Scenario, to: &Scenario) -> Vec<InputError> {
    let error = |path: &str, given: String, was: String| {
        let allowed = format!("{was}, as when the run began");
        InputError::new(path.to_owned(), Some(given), allowed)
    };
    let mut errors = Vec::new();
    let [was_s, is_s] = [from, to].map(Scenario::step_s);
    if was_s.to_bits() != is_s.to_bits() {
        errors.push(error("clock.step_s", is_s.to_string(), was_s.to_string()));
    }
    let [was, is] = [from, to].map(|scenario| scenario.world().size());
    if was != is {
        let shown = |size: base::geometry::Point| format!("[{}, {}]", size.x, size.y);
        errors.push(error("world.size_m", shown(is), shown(was)));
    }
    for (key, of) in [
        (
            "clock.max_offset_s",
            Scenario::max_clock_offset_s as fn(&Scenario) -> f64,
        ),
        ("clock.max_drift", Scenario::max_clock_drift),
    ] {
        let [was, is] = [from, to].map(of);
        if was.to_bits() != is.to_bits() {
            errors.push(error(key, is.to_string(), was.to_string()));
        }
    }
    let [was, is] = [from, to].map(Scenario::is_periodic);
    if was != is {
        errors.push(error("world.periodic", is.to_string(), was.to_string()));
    }
    errors
}

/// The error that a run has no room for an entity, by the name of its kind.
fn no_room(scenario: &Scenario, why: NoRoom) -> PyErr {
    let named =
        |kind: u8, index: u32, names: Vec<&str>, what: &str, why: &dyn std::fmt::Display| {
            let name = names.get(usize::from(kind)).copied().unwrap_or_default();
            let sentence = format!("{what}.{name}: the run has no room for {name}/{index}: {why}");
            InputError::new(String::new(), None, sentence)
        };
    let error = match why {
        NoRoom::Item { kind, index, why } => {
            named(kind, index, scenario.item_kinds().collect(), "items", &why)
        }
        NoRoom::Goal { kind, index, why } => {
            named(kind, index, scenario.goal_kinds().collect(), "goals", &why)
        }
        NoRoom::Controller { id, why } => {
            let kinds = scenario.robot_kinds().chain(scenario.controller_kinds());
            named(id.kind, id.index, kinds.collect(), "controllers", &why)
        }
        NoRoom::Robot(robot) => named(
            robot.kind,
            robot.index,
            scenario.robot_kinds().collect(),
            "robots",
            &robot.why,
        ),
    };
    no_room_error(&InputErrors(vec![error]))
}
