//! Decisions made outside brains, in two halves of a step.
//!
//! In the first half these robots sense, which changes nothing: their percepts come from copies of their
//! inputs. Only the second half takes the step, so that the run is unchanged if no decision comes.

use super::decide::WorkerScratch;
use super::external::ExternalInputs;
use super::pending_decisions::PendingDecision;
use super::tick::StepScratch;
use super::view::View;
use crate::run::agent::Agent;
use crate::run::state::State;
use crate::scenario::Scenario;
use brain::Motion;
use rayon::prelude::*;

impl StepScratch {
    /// Lets the robots of some kinds sense whose brains step now, and the controllers; the state does not change.
    pub(crate) fn request_decisions(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        kinds: &[u8],
        external: &mut ExternalInputs,
    ) {
        self.refresh(scenario, state);
        let is_shared = self.prepare_workers(state);
        let mut decisions = std::mem::take(&mut self.decisions);
        let (view, agents) = state.view(scenario, &self.neighbours);
        let robots = agents.iter_mut().enumerate();
        let due = robots.filter(|(robot, _)| {
            let is_free = !external.commands.contains_key(robot);
            is_free && kinds.contains(&view.ids[*robot].kind) && view.is_due(*robot)
        });
        let mut due: Vec<(usize, &mut Agent)> = due.collect();
        decisions
            .all
            .resize_with(due.len(), PendingDecision::default);
        let size = due.len().div_ceil(self.workers.len()).max(1);
        let request = |((worker, due), decisions): Chunk| {
            for ((robot, agent), decision) in due.iter_mut().zip(decisions) {
                worker.request_decision(&view, *robot, agent, decision);
            }
        };
        if is_shared {
            let tasks = self.workers.par_iter_mut().zip(due.par_chunks_mut(size));
            let tasks = tasks.zip(decisions.all.par_chunks_mut(size));
            tasks.for_each(request);
        } else {
            let tasks = self.workers.iter_mut().zip(due.chunks_mut(size));
            tasks.zip(decisions.all.chunks_mut(size)).for_each(request);
        }
        decisions.detections.clear();
        for worker in &self.workers {
            decisions.detections.add(&worker.sensing.detections);
        }
        external.decisions = decisions;
        self.controllers
            .request_decisions((scenario, state), kinds, external);
    }
}

/// The part of one thread: its scratch, its robots, and their decisions.
type Chunk<'a, 'm> = (
    (&'a mut WorkerScratch, &'a mut [(usize, &'m mut Agent)]),
    &'a mut [PendingDecision],
);

impl WorkerScratch {
    /// Lets one robot sense whose brain steps now, and leaves its inputs as they are.
    fn request_decision(
        &mut self,
        view: &View,
        robot: usize,
        agent: &mut Agent,
        decision: &mut PendingDecision,
    ) {
        let before = agent.inputs.clone();
        self.perceive(view, robot, agent);
        decision.inputs = std::mem::replace(&mut agent.inputs, before);
        std::mem::swap(&mut decision.percept, &mut self.percept);
        (decision.number, decision.robot) = (robot, view.ids[robot]);
        decision.command.motion = Motion::default();
        decision.command.requests.clear();
        decision.command.outbox.clear();
    }
}
