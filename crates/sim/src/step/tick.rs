//! One step of a run: sense, communicate, decide, act, judge.

use super::act::Moves;
use super::acts;
use super::agent_events::{self, AgentEvents};
use super::clearance;
use super::communicate;
use super::convoy;
use super::decide::WorkerScratch;
use super::decision::DecisionInputs;
use super::decision_hash::{add_decisions, add_setpoints};
use super::direct::ControllerScratch;
use super::external::ExternalInputs;
use super::flock_step::flock_step;
use super::flocks::Flocks;
use super::hazards;
use super::mixed_percept::Perceived;
use super::neighbours::Neighbours;
use super::parallel::is_worth_sharing;
use super::pending_decisions::{PendingDecision, PendingDecisions};
use super::plan::{Plan, planned};
use crate::judge::detections::Detections;
use crate::judge::events::EventLog;
use crate::judge::goal_moment::GoalMoment;
use crate::run::agent::Agent;
use crate::run::state::State;
use crate::scenario::Scenario;
use brain::{Command, Percept};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::iter;

/// Buffers and lists that steps use besides the state of the run; none of them changes an outcome.
/// They are kept from step to step, so that only the first steps allocate.
#[derive(Debug, Clone)]
pub(crate) struct StepScratch {
    pub(crate) neighbours: Neighbours,
    flocks: Flocks,
    pub(super) workers: Vec<WorkerScratch>,
    pub(super) controllers: ControllerScratch,
    /// The decisions of the last step that were made outside its brains.
    pub(crate) decisions: PendingDecisions,
    moves: Moves,
    /// The robots with external bodies.
    pub(crate) external: Vec<usize>,
    /// What external bodies perceived last, by the number of the robot.
    perceived: BTreeMap<usize, Perceived>,
    /// Readers of what happens in the run.
    pub(crate) events: EventLog,
    pub(crate) agent_events: AgentEvents,
    /// Whether threads may share the work of one step.
    may_share: bool,
    has_beliefs: bool,
}

/// The part of one thread: its scratch, and the agents and plans of its robots.
type Chunk<'a> = ((&'a mut WorkerScratch, &'a mut [Agent]), &'a mut [Plan]);

impl StepScratch {
    pub(crate) fn new(scenario: &Scenario, may_share: bool) -> Self {
        Self {
            neighbours: Neighbours::new(scenario),
            flocks: Flocks::new(scenario),
            workers: Vec::new(),
            controllers: ControllerScratch::default(),
            decisions: PendingDecisions::default(),
            moves: Moves::default(),
            external: Vec::new(),
            perceived: BTreeMap::new(),
            events: EventLog::default(),
            agent_events: AgentEvents::default(),
            may_share,
            has_beliefs: scenario.kinds.iter().any(|kind| kind.brain.has_beliefs()),
        }
    }

    /// Takes one step without external inputs.
    pub(crate) fn step(&mut self, scenario: &Scenario, state: &mut State) {
        self.tick(scenario, state, &ExternalInputs::default());
    }

    /// Drops what is cached about robots: another run begins, or this one was changed.
    pub(crate) fn invalidate(&mut self) {
        self.neighbours.forget();
        self.agent_events.forget();
        self.perceived.clear();
    }

    /// Notes that these external bodies were placed, none of them farther than this from where it was.
    pub(crate) fn note_placed(&mut self, external: Vec<usize>, farthest_m: f64) {
        self.external = external;
        self.neighbours.note(farthest_m);
    }

    /// Takes one step.
    pub(crate) fn tick(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        external: &ExternalInputs,
    ) {
        self.events.begin_step(&state.body_states);
        self.agent_events.begin_step(&self.events, scenario, state);
        let is_counted = if scenario.is_of_flocks_of_points() && external.is_empty() {
            self.flock_step(scenario, state);
            add_setpoints(scenario, state);
            false
        } else {
            self.refresh(scenario, state);
            self.sense_decide_and_plan(scenario, state, external);
            self.keep_perceived(external);
            state.issue_goals(scenario);
            self.direct(scenario, state, external);
            let is_stated = clearance::observe(scenario, state, &self.workers);
            let hashes = self.workers.iter().flat_map(|worker| &worker.decisions);
            add_decisions(state, hashes);
            let sent = self.workers.iter().flat_map(|worker| &worker.outbox);
            agent_events::note_sent(&self.events, state, sent);
            communicate::send(scenario, state, &self.neighbours, &self.workers);
            let is_counted = self.judge_goals(scenario, state);
            let sent = self.workers.iter().flat_map(|worker| &worker.outbox);
            state.answer_reports(scenario, sent);
            let collisions = self.act(scenario, state) + self.touch_external(scenario, state);
            let is_counted = hazards::detonate(scenario, state, &self.events) | is_counted;
            let is_counted = convoy::drive(scenario, state, &self.events) | is_counted;
            let is_counted = acts::carry_out(scenario, state, &self.events) | is_counted;
            self.judge((scenario, state), external, collisions) | is_counted | is_stated
        };
        if scenario.has_failures {
            state.fail(scenario);
        }
        self.events
            .end_step(state.tick, &state.ids, &state.body_states);
        self.agent_events.end_step(&self.events, scenario, state);
        state.note_completion(scenario, is_counted);
        state.tick += 1;
        communicate::deliver(state);
    }

    fn is_shared(&self, state: &State) -> bool {
        self.may_share && is_worth_sharing(state.robots(), self.has_beliefs)
    }

    /// Brings the lists of neighbours up to date.
    pub(crate) fn refresh(&mut self, scenario: &Scenario, state: &State) {
        let is_shared = self.is_shared(state);
        self.neighbours
            .refresh(scenario, &state.ids, &state.discs, is_shared);
    }

    /// A step of robots that are never in each other's way, send nothing and find nothing.
    fn flock_step(&mut self, scenario: &Scenario, state: &mut State) {
        let is_shared = self.is_shared(state);
        let (view, _) = state.view(scenario, &self.neighbours);
        self.flocks.compute(&view, is_shared);
        let moved = flock_step(scenario, state, &self.flocks, is_shared);
        self.neighbours.note(moved.farthest_m);
    }

    /// Clears the scratch of all threads that share the work of a step; returns whether more than one does.
    pub(super) fn prepare_workers(&mut self, state: &State) -> bool {
        let is_shared = self.is_shared(state);
        let workers = if is_shared {
            4 * rayon::current_num_threads()
        } else {
            1
        };
        self.workers.resize_with(workers, WorkerScratch::default);
        self.workers.iter_mut().for_each(WorkerScratch::clear);
        is_shared
    }

    /// Lets all robots sense, decide and plan their paths, each from the same view: one robot
    /// completely before the next, so that its data is read from memory once.
    fn sense_decide_and_plan(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        external: &ExternalInputs,
    ) {
        let is_shared = self.prepare_workers(state);
        let robots = state.robots();
        let plans = self.moves.plans(robots);
        let hashes_decisions = state.decisions.is_some();
        let (view, agents) = state.view(scenario, &self.neighbours);
        self.flocks.compute(&view, is_shared);
        let inputs = DecisionInputs {
            view: &view,
            external: (!external.is_empty()).then_some(external),
            flocks: &self.flocks,
            hashes_decisions,
        };
        let size = robots.div_ceil(self.workers.len()).max(1);
        let serve = |(number, ((worker, agents), plans)): (usize, Chunk)| {
            for (place, (agent, plan)) in agents.iter_mut().zip(plans).enumerate() {
                let robot = number * size + place;
                worker.serve(&inputs, robot, agent);
                agent.queue_setpoint();
                *plan = planned(scenario, view.tick, &view.body(robot, agent));
            }
        };
        if is_shared {
            let tasks = self.workers.par_iter_mut();
            let tasks = tasks.zip(agents.par_chunks_mut(size));
            let tasks = tasks.zip(plans.par_chunks_mut(size));
            tasks.enumerate().for_each(serve);
        } else {
            let tasks = self.workers.iter_mut().zip(agents.chunks_mut(size));
            let tasks = tasks.zip(plans.chunks_mut(size));
            tasks.enumerate().for_each(serve);
        }
    }

    /// Lets all controllers step.
    fn direct(&mut self, scenario: &Scenario, state: &mut State, external: &ExternalInputs) {
        if let Some(last) = self.workers.last_mut() {
            self.controllers.step((scenario, state), external, last);
        }
    }

    /// What a robot will perceive in the next step, if its brain steps in it.
    pub(crate) fn percept(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        robot: usize,
    ) -> Option<Percept> {
        self.refresh(scenario, state);
        let (view, agents) = state.view(scenario, &self.neighbours);
        if !view.is_due(robot) {
            return None;
        }
        let agent = &mut agents[robot];
        let inputs = agent.inputs.clone();
        let mut worker = WorkerScratch::default();
        worker.perceive(&view, robot, agent);
        agent.inputs = inputs;
        Some(worker.percept)
    }

    /// The robots of the last step for which decisions were made outside their brains.
    pub(crate) fn decided(&self) -> &[PendingDecision] {
        &self.decisions.all
    }

    /// What a robot with an external body perceived last, if anything.
    pub(crate) fn perceived(&self, robot: usize) -> Option<&Perceived> {
        self.perceived.get(&robot)
    }

    /// Keeps what external bodies perceived in this step: those whose brains stepped, and the others.
    fn keep_perceived(&mut self, external: &ExternalInputs) {
        let decided = self.workers.iter_mut();
        let decided = decided.flat_map(|worker| worker.perceived.drain(..));
        self.perceived.extend(decided);
        let observed = external.observed.iter();
        let observed = observed.map(|(robot, percept)| (*robot, Perceived::of(percept)));
        self.perceived.extend(observed);
    }

    /// The commands that brains decided for external bodies, by the number of the robot.
    pub(crate) fn external_commands(&mut self) -> impl Iterator<Item = (usize, Command)> {
        self.workers
            .iter_mut()
            .flat_map(|worker| worker.external_commands.drain(..))
    }

    /// Moves all bodies; returns the number of collisions.
    fn act(&mut self, scenario: &Scenario, state: &mut State) -> u64 {
        let is_shared = self.is_shared(state);
        let moved = self.moves.act(scenario, state, &self.neighbours, is_shared);
        self.neighbours.note(moved.farthest_m);
        moved.collisions
    }

    /// Reports to the judge where robots are and what they sent, if there are goals; returns whether anything was
    /// counted.
    fn judge_goals(&self, scenario: &Scenario, state: &mut State) -> bool {
        let Some(tally) = &mut state.tally.goals else {
            return false;
        };
        let moment = GoalMoment {
            scenario,
            tick: state.tick,
            goals: &state.goals,
            ids: &state.ids,
            discs: &state.discs,
            body_states: &state.body_states,
        };
        let sent = self.workers.iter().flat_map(|worker| &worker.outbox);
        let unsent_done = self.workers.iter().flat_map(|worker| &worker.unsent_done);
        tally.observe(&moment, (sent, unsent_done), &self.events)
    }

    /// Reports to the judge what robots detected in this step, and their collisions; returns whether anything was
    /// counted.
    fn judge(
        &self,
        (scenario, state): (&Scenario, &mut State),
        external: &ExternalInputs,
        collisions: u64,
    ) -> bool {
        let State {
            tick,
            items,
            tally,
            ids,
            ..
        } = state;
        let step = (*tick, &*items, &ids[..]);
        let mut is_counted = tally.collided(collisions);
        let here = self.workers.iter().map(|worker| &worker.sensing.detections);
        if external.decisions.all.is_empty() {
            for detections in here {
                tally.ground_detected(detections, (scenario, ids));
                is_counted |= tally.detected(detections, step, &self.events);
            }
        } else {
            let all = iter::once(&external.decisions.detections).chain(here);
            let all = Detections::merged(all);
            tally.ground_detected(&all, (scenario, ids));
            is_counted |= tally.detected(&all, step, &self.events);
        }
        is_counted
    }
}
