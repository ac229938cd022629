//! One run, stepped by hand.

use super::asked::Asked;
use super::mind::Mind;
use super::neighbours::Neighbours;
use super::outcome::Outcome;
use super::outside::Outside;
use super::state::{NoRoom, State};
use super::tick::Workshop;
use super::view::View;
use super::watch::Watch;
use crate::body::path::Course;
use crate::clock::seconds;
use crate::scenario::Scenario;
use base::geometry::Point;
use brain::{Command, Percept, RobotId};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A run, and what it needs to go on.
///
/// A body can be outside: from the first percept that [`Simulation::step_with`] gets for a robot, it
/// is where its percepts say, and its brain's commands are handed out instead of carried out. In a
/// step without a percept it stands, and its brain is not asked. It knows for itself how it fares:
/// it neither breaks nor empties here, and takes no energy.
#[derive(Debug, Clone)]
pub struct Simulation {
    scenario: Arc<Scenario>,
    pub(super) state: State,
    workshop: Workshop,
    pub(super) watch: Watch,
}

/// A robot that a run does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("there is no robot {} of kind {}", .0.index, .0.kind)]
pub struct NoRobot(pub RobotId);

impl Simulation {
    /// A run at its beginning. Threads share the work of its steps if there are thousands of robots.
    ///
    /// # Errors
    /// If the world has no room for an item or a robot.
    pub fn new(scenario: Arc<Scenario>, seed: u64, run: u64) -> Result<Self, NoRoom> {
        let state = State::new(&scenario, seed, run)?;
        let workshop = Workshop::new(&scenario, true);
        Ok(Self {
            scenario,
            state,
            workshop,
            watch: Watch::default(),
        })
    }

    /// Takes one step, also after the run is over.
    pub fn step(&mut self) {
        self.look();
        self.workshop.step(&self.scenario, &mut self.state);
    }

    /// Takes one step with percepts of bodies outside, and with commands that stand for what the
    /// brains of other robots would decide; returns what the brains of bodies outside decide.
    ///
    /// # Errors
    /// If a robot is not there; then no step is taken.
    pub fn step_with(
        &mut self,
        percepts: BTreeMap<RobotId, Percept>,
        commands: BTreeMap<RobotId, Command>,
    ) -> Result<BTreeMap<RobotId, Command>, NoRobot> {
        let outside = self.outside(percepts, commands)?;
        Ok(self.answer(outside))
    }

    /// Begins such a step for a run in which others decide for the robots of some `kinds`: those
    /// whose brains step in it, with what they perceive. What is decided is written to them, and
    /// [`Simulation::answer`] takes the step. Until then nothing has changed but where bodies
    /// outside are.
    ///
    /// # Errors
    /// If a robot is not there.
    pub fn ask(
        &mut self,
        percepts: BTreeMap<RobotId, Percept>,
        commands: BTreeMap<RobotId, Command>,
        kinds: &[u8],
    ) -> Result<Outside, NoRobot> {
        let mut outside = self.outside(percepts, commands)?;
        self.workshop
            .ask(&self.scenario, &mut self.state, kinds, &mut outside);
        Ok(outside)
    }

    /// Takes the step that [`Simulation::ask`] began, which must be the last thing that was done to
    /// the run; returns what the brains of bodies outside decide.
    pub fn answer(&mut self, mut outside: Outside) -> BTreeMap<RobotId, Command> {
        outside.asking.settle(&mut self.state.minds);
        self.watch.forget();
        self.workshop
            .tick(&self.scenario, &mut self.state, &outside);
        self.workshop.asking = outside.asking;
        let ids = &self.state.ids;
        self.workshop
            .answers()
            .map(|(robot, command)| (ids[robot], command))
            .collect()
    }

    /// The robots of the last answered step for which others decided.
    #[must_use]
    pub fn asked(&self) -> &[Asked] {
        self.workshop.asked()
    }

    /// What a robot will perceive in the next step; `None` if its brain does not step in it, or if
    /// its body is outside or cannot go on.
    ///
    /// # Errors
    /// If the robot is not there.
    pub fn percept(&mut self, id: RobotId) -> Result<Option<Percept>, NoRobot> {
        let robot = self.number(id)?;
        Ok(self
            .workshop
            .percept(&self.scenario, &mut self.state, robot))
    }

    /// Takes steps until the run is over.
    pub fn finish(&mut self) -> Outcome {
        while !self.state.is_over(&self.scenario) {
            self.step();
        }
        self.outcome()
    }

    /// What the run has given so far.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        Outcome::of(&self.scenario, &self.state)
    }

    /// Time that its steps so far took in the world.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        seconds(self.state.tick(), self.scenario.step_s)
    }

    /// What the run is of.
    #[must_use]
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    /// Where the run is: a copy of it can be kept and put back.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Sees to it that neighbours are known.
    pub(super) fn refresh(&mut self) {
        self.workshop.refresh(&self.scenario, &self.state);
    }

    /// What robots sense and decide from now, and their minds.
    pub(super) fn view(&mut self) -> (View<'_>, &mut [Mind]) {
        self.refresh();
        self.state.view(&self.scenario, &self.workshop.neighbours)
    }

    pub(super) fn neighbours(&self) -> &Neighbours {
        &self.workshop.neighbours
    }

    /// Puts the run where it was when `state` was copied from it.
    pub fn restore(&mut self, state: State) {
        self.state = state;
        self.workshop.forget();
        self.watch.forget();
    }

    /// Goes on with another scenario: see [`State::changed`].
    ///
    /// # Errors
    /// If the world has no room for an item or robot that comes in; then nothing has changed.
    pub fn change(&mut self, scenario: Arc<Scenario>) -> Result<(), NoRoom> {
        let state = self.state.changed(&self.scenario, &scenario)?;
        self.go_on(scenario, state);
        Ok(())
    }

    /// Goes on with another scenario, from the state that [`State::changed`] gave for it.
    pub fn go_on(&mut self, scenario: Arc<Scenario>, state: State) {
        self.state = state;
        self.workshop = Workshop::new(&scenario, true);
        self.scenario = scenario;
        self.watch = Watch::default();
    }

    /// What comes from outside into a step, with bodies outside where their percepts say.
    fn outside(
        &mut self,
        percepts: BTreeMap<RobotId, Percept>,
        commands: BTreeMap<RobotId, Command>,
    ) -> Result<Outside, NoRobot> {
        let outside = Outside {
            percepts: self.numbered(percepts)?,
            commands: self.numbered(commands)?,
            ..Outside::default()
        };
        for (robot, percept) in &outside.percepts {
            self.put_outside(*robot, percept);
        }
        Ok(outside)
    }

    /// The body is outside, and where its percept says.
    fn put_outside(&mut self, robot: usize, percept: &Percept) {
        self.state.hulls[robot].is_external = true;
        let is_finite = |at: &Point| at.x.is_finite() && at.y.is_finite();
        if let Some(at) = percept.position.map(|read| read.value).filter(is_finite) {
            self.state.discs[robot].centre = self.scenario.home(at);
            self.workshop.forget();
        }
        let heading_rad = percept.heading_rad.map(|read| read.value);
        if let Some(heading_rad) = heading_rad.filter(|heading_rad| heading_rad.abs() < 1e6) {
            self.state.courses[robot] = Course::new(heading_rad);
        }
    }

    fn numbered<T>(&self, given: BTreeMap<RobotId, T>) -> Result<BTreeMap<usize, T>, NoRobot> {
        given
            .into_iter()
            .map(|(id, what)| Ok((self.number(id)?, what)))
            .collect()
    }

    pub(super) fn number(&self, id: RobotId) -> Result<usize, NoRobot> {
        self.state.ids.binary_search(&id).map_err(|_| NoRobot(id))
    }
}
