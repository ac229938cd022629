//! One run, stepped by its caller.

mod collision_warnings;
mod external_errors;
mod external_view;
mod footprints;
mod hashes;
mod inspect;
mod links;
mod probe;

pub use external_view::{Detected, ExternalView};
pub use footprints::{Footprint, Sensors};
pub use inspect::Inspected;
pub use links::Link;

use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::external::{ExternalBody, ExternalSpec, Read};
use crate::bodies::source::BodySource;
use crate::clock::seconds;
use crate::judge::Outcome;
use crate::judge::events::{EventLog, EventReader};
use crate::run::agent::Agent;
use crate::run::placing::NoRoom;
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::step::direct::ControllerScratch;
use crate::step::external::ExternalInputs;
use crate::step::mixed_percept::Perceived;
use crate::step::neighbours::Neighbours;
use crate::step::pending_decisions::PendingDecision;
use crate::step::tick::StepScratch;
use crate::step::view::View;
use brain::{AgentId, Command, Percept};
use probe::Probe;
use std::collections::BTreeMap;
use std::mem;
use std::sync::Arc;

/// A run, and what it needs to continue.
///
/// A body can be external, from the start ([`Simulation::with_external`]) or from the first percept that
/// [`Simulation::step_with`] gets for a robot: its pose comes from its percepts, and the commands of its
/// brain are returned instead of executed. In a step without a percept it moves by its last command, for two
/// periods of its brain at most, and its brain does not step; nor does it with a percept that is only observed. A percept that is not later than the one before is ignored: the last motion is returned
/// again. Its damage and battery are not simulated: it neither breaks nor runs empty, and uses no energy.
#[derive(Debug, Clone)]
pub struct Simulation {
    scenario: Arc<Scenario>,
    pub(super) state: State,
    scratch: StepScratch,
    probe: Probe,
    /// Whether any body is external.
    has_external: bool,
}

/// What comes from outside of a run for one step.
#[derive(Debug, Clone, Default)]
pub struct StepInputs {
    /// Percepts of external bodies, from which their brains decide.
    pub percepts: BTreeMap<AgentId, Percept>,
    /// Percepts of external bodies whose brains do not step, as while a person drives one: they state where
    /// it is.
    pub observed: BTreeMap<AgentId, Percept>,
    /// Commands that replace the decisions of other brains and of controllers.
    pub commands: BTreeMap<AgentId, Command>,
}

/// There is no such robot or controller in the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("there is no robot or controller {} of kind {}", .0.index, .0.kind)]
pub struct NoRobot(pub AgentId);

impl Simulation {
    /// A new run. Threads share the work of its steps if there are thousands of robots.
    ///
    /// # Errors
    /// If the world has no room for an item or a robot.
    pub fn new(scenario: Arc<Scenario>, seed: u64, run: u64) -> Result<Self, NoRoom> {
        let state = State::new(&scenario, seed, run)?;
        let scratch = StepScratch::new(&scenario, true);
        Ok(Self {
            scenario,
            state,
            scratch,
            probe: Probe::default(),
            has_external: false,
        })
    }

    /// The run, with external bodies of these robots. Until its first percept, such a body stands where it
    /// starts.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn with_external(
        mut self,
        bodies: impl IntoIterator<Item = (AgentId, ExternalSpec)>,
    ) -> Result<Self, NoRobot> {
        for (id, spec) in bodies {
            let robot = self.number(id)?;
            self.make_external(robot, &Arc::new(spec));
        }
        Ok(self)
    }

    /// Takes one step, also after the run is over.
    pub fn step(&mut self) {
        self.record_decision();
        self.place_external(&ExternalInputs::default());
        self.scratch.step(&self.scenario, &mut self.state);
    }

    /// Takes one step with percepts of external bodies, and with commands that replace the decisions
    /// of other brains and of controllers; returns the commands that brains decided for external bodies.
    ///
    /// # Errors
    /// If there is no such robot or controller; then no step is taken.
    pub fn step_with(
        &mut self,
        percepts: BTreeMap<AgentId, Percept>,
        commands: BTreeMap<AgentId, Command>,
    ) -> Result<BTreeMap<AgentId, Command>, NoRobot> {
        let external = self.external_inputs(StepInputs {
            percepts,
            commands,
            ..StepInputs::default()
        })?;
        Ok(self.finish_step(external))
    }

    /// Begins such a step for a run in which the decisions for the robots or controllers of some `kinds` are
    /// made elsewhere: returns those that step in it, with their percepts. Decisions are
    /// written to them, and [`Simulation::finish_step`] takes the step. Until then nothing has
    /// changed but the poses of external bodies.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn begin_step(
        &mut self,
        inputs: StepInputs,
        kinds: &[u8],
    ) -> Result<ExternalInputs, NoRobot> {
        let mut external = self.external_inputs(inputs)?;
        self.scratch
            .request_decisions(&self.scenario, &mut self.state, kinds, &mut external);
        Ok(external)
    }

    /// Takes the step that [`Simulation::begin_step`] began, which must be the last call on this run;
    /// returns the commands that brains decided for external bodies.
    pub fn finish_step(&mut self, mut external: ExternalInputs) -> BTreeMap<AgentId, Command> {
        external.decisions.settle(&mut self.state.agents);
        self.probe.forget();
        self.scratch
            .tick(&self.scenario, &mut self.state, &external);
        let repeated: Vec<_> = self.repeated_commands(&external).collect();
        self.scratch.decisions = external.decisions;
        let ids = &self.state.ids;
        let decided = self
            .scratch
            .external_commands()
            .inspect(|(robot, command)| {
                if let Some(external) = self.state.body_states[*robot].external_mut() {
                    external.command(command.motion);
                }
            });
        let commands = repeated.into_iter().chain(decided);
        commands
            .map(|(robot, command)| (ids[robot], command))
            .collect()
    }

    /// The robots and controllers of the last finished step whose decisions were made elsewhere.
    #[must_use]
    pub fn decided(&self) -> &[PendingDecision] {
        self.scratch.decided()
    }

    /// What a robot with an external body perceived in the last step that had a percept of it, if there was one.
    ///
    /// # Errors
    /// If there is no such robot.
    pub fn perceived(&self, id: AgentId) -> Result<Option<&Perceived>, NoRobot> {
        Ok(self.scratch.perceived(self.number(id)?))
    }

    /// What a robot or controller will perceive in the next step; `None` if its brain does not step in it, if
    /// its body is external or cannot move any more, or if the controller does not work.
    ///
    /// # Errors
    /// If there is no such robot or controller.
    pub fn percept(&mut self, id: AgentId) -> Result<Option<Percept>, NoRobot> {
        let number = self.participant(id)?;
        let (scenario, state) = (&self.scenario, &mut self.state);
        Ok(match number.checked_sub(state.robots()) {
            None => self.scratch.percept(scenario, state, number),
            Some(controller) => ControllerScratch::percept(scenario, state, controller),
        })
    }

    /// Takes steps until the run is over.
    pub fn finish(&mut self) -> Outcome {
        while !self.state.is_over(&self.scenario) {
            self.step();
        }
        self.outcome()
    }

    /// The outcome so far.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.state.outcome(&self.scenario)
    }

    /// Simulated time.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        seconds(self.state.tick(), self.scenario.step_s)
    }

    /// Its scenario.
    #[must_use]
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    /// Its state: a copy of it can be kept and restored.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Brings the lists of neighbours up to date.
    pub(super) fn refresh(&mut self) {
        self.scratch.refresh(&self.scenario, &self.state);
    }

    /// What robots sense and decide from in the next step, and their agents.
    pub(super) fn view(&mut self) -> (View<'_>, &mut [Agent]) {
        self.refresh();
        self.state.view(&self.scenario, &self.scratch.neighbours)
    }

    pub(super) fn neighbours(&self) -> &Neighbours {
        &self.scratch.neighbours
    }

    /// Returns to a state that was copied from this run.
    pub fn restore(&mut self, state: State) {
        self.state = state;
        self.has_external = self.state.body_states.iter().any(BodyState::is_external);
        self.scratch.invalidate();
        self.scratch
            .events
            .continue_from(self.state.tick, &self.scenario);
        self.probe.forget();
    }

    /// Returns to a copy of this run, which may have another scenario. Readers of its events stay.
    pub fn return_to(&mut self, copy: Self) {
        let events = mem::take(&mut self.scratch.events);
        *self = copy;
        self.keep_readers(events);
    }

    /// A reader of what happens in this run from now on. If the run returns to an earlier step, the events after
    /// it are removed, unless they were read before. Copies of the run have no readers.
    pub fn event_reader(&mut self) -> EventReader {
        self.scratch.events.reader(&self.scenario)
    }

    /// Continues with another scenario: see [`State::changed`].
    ///
    /// # Errors
    /// If the world has no room for an item or robot that is added; then nothing has changed.
    pub fn change(&mut self, scenario: Arc<Scenario>) -> Result<(), NoRoom> {
        let state = self.state.changed(&self.scenario, &scenario)?;
        self.continue_with(scenario, state);
        Ok(())
    }

    /// Continues with another scenario, from the state that [`State::changed`] returned for it.
    pub fn continue_with(&mut self, scenario: Arc<Scenario>, state: State) {
        self.state = state;
        let events = mem::take(&mut self.scratch.events);
        self.scratch = StepScratch::new(&scenario, true);
        self.scenario = scenario;
        self.scratch.external = self.external_robots();
        self.state
            .note_regions(&self.scenario, &self.scratch.external);
        self.keep_readers(events);
        self.probe = Probe::default();
    }

    fn keep_readers(&mut self, mut events: EventLog) {
        events.continue_from(self.state.tick, &self.scenario);
        self.scratch.events = events;
        self.scratch.agent_events.forget();
    }

    /// The external inputs of a step; moves external bodies to the poses of their percepts.
    fn external_inputs(&mut self, inputs: StepInputs) -> Result<ExternalInputs, NoRobot> {
        let mut external = ExternalInputs {
            percepts: numbered(inputs.percepts, |id| self.number(id))?,
            observed: numbered(inputs.observed, |id| self.number(id))?,
            commands: numbered(inputs.commands, |id| self.participant(id))?,
            ..ExternalInputs::default()
        };
        let plain = Arc::default();
        for robot in external.percepts.keys().chain(external.observed.keys()) {
            if !self.state.body_states[*robot].is_external() {
                self.make_external(*robot, &plain);
            }
        }
        let agents = &self.state.agents;
        external.keep_later(|robot, percept| agents[robot].brain.is_later(percept));
        self.place_external(&external);
        Ok(external)
    }

    fn make_external(&mut self, robot: usize, spec: &Arc<ExternalSpec>) {
        self.has_external = true;
        let kind = self.scenario.kind_of(self.state.ids[robot]);
        let external = ExternalBody::new(spec.clone(), kind);
        self.state.body_states[robot].source = BodySource::External(Box::new(external));
    }

    /// Moves external bodies to where they are now, by their percepts of this step and, without one, by
    /// their commands.
    fn place_external(&mut self, inputs: &ExternalInputs) {
        if !self.has_external {
            return;
        }
        let external = self.external_robots();
        let mut farthest_m: f64 = 0.0;
        for robot in external.iter().copied() {
            let decides = inputs.percepts.get(&robot).map(Read::Decides);
            let read = decides.or_else(|| inputs.observed.get(&robot).map(Read::Only));
            let read = read.unwrap_or(Read::Nothing);
            farthest_m = farthest_m.max(self.state.place_external(&self.scenario, robot, read));
        }
        self.state.note_regions(&self.scenario, &external);
        self.scratch.note_placed(external, farthest_m);
    }

    /// The robots with external bodies.
    fn external_robots(&mut self) -> Vec<usize> {
        let mut external = mem::take(&mut self.scratch.external);
        external.clear();
        let bodies = self.state.body_states.iter().enumerate();
        let bodies = bodies.filter(|(_, body_state)| body_state.is_external());
        external.extend(bodies.map(|(robot, _)| robot));
        external
    }

    /// The commands for the bodies whose percepts were ignored: the last motion.
    fn repeated_commands(
        &self,
        external: &ExternalInputs,
    ) -> impl Iterator<Item = (usize, Command)> {
        let is_active = |robot: &&usize| self.state.body_states[**robot].status == Status::Active;
        let active = external.repeated.iter().filter(is_active);
        active.map(|robot| (*robot, self.state.agents[*robot].brain.last_command()))
    }

    /// The number of a robot or controller among all participants.
    fn participant(&self, id: AgentId) -> Result<usize, NoRobot> {
        let controllers = &self.state.controllers;
        self.number(id).or_else(|no_robot| {
            let place = controllers.binary_search_by_key(&id, |agent| agent.participant.id);
            let place = place.map_err(|_| no_robot)?;
            Ok(self.state.robots() + place)
        })
    }

    pub(super) fn number(&self, id: AgentId) -> Result<usize, NoRobot> {
        self.state.ids.binary_search(&id).map_err(|_| NoRobot(id))
    }
}

fn numbered<T>(
    given: BTreeMap<AgentId, T>,
    number: impl Fn(AgentId) -> Result<usize, NoRobot>,
) -> Result<BTreeMap<usize, T>, NoRobot> {
    let entries = given.into_iter();
    entries.map(|(id, what)| Ok((number(id)?, what))).collect()
}
