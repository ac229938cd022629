//! Controllers step: each from what it has received, whatever robots decide in the same step.

use super::decide::{WorkerScratch, send};
use super::decision_hash::decision_hash;
use super::external::ExternalInputs;
use super::pending_decisions::PendingDecision;
use super::surroundings::{Moment, Surroundings};
use crate::run::controller::ControllerAgent;
use crate::run::participant::{Participant, Place};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use brain::{Command, Percept, Reading, ReceivedMessage};

/// Buffers of the controllers, reused in each step.
#[derive(Debug, Clone, Default)]
pub(crate) struct ControllerScratch {
    percept: Percept,
    command: Command,
    surroundings: Surroundings,
}

impl ControllerScratch {
    /// Lets all controllers step for which there is no external command and no decision made elsewhere. Their messages
    /// and decisions are added to those of the last robots.
    pub(crate) fn step(
        &mut self,
        (scenario, state): (&Scenario, &mut State),
        external: &ExternalInputs,
        results: &mut WorkerScratch,
    ) {
        self.surroundings.refresh(scenario, state);
        let moment = Moment {
            scenario,
            tick: state.tick,
            body_states: &state.body_states,
            items: &state.items,
        };
        let hashes_decisions = state.decisions.is_some();
        for (number, agent) in (state.agents.len()..).zip(&mut state.controllers) {
            if !agent.participant.is_working(moment.body_states) {
                continue;
            }
            self.perceive(&moment, &mut agent.participant);
            let decided = external.decisions.decided(number);
            let given = external.commands.get(&number);
            let elsewhere = given.or_else(|| decided.map(|each| &each.command));
            agent.is_elsewhere = elsewhere.is_some();
            match elsewhere {
                Some(command) => self.command.clone_from(command),
                None => agent.controller.step_into(&self.percept, &mut self.command),
            }
            agent.note_acts(&self.command.acts);
            if hashes_decisions {
                let hash = decision_hash(number, Some(&self.percept), &self.command);
                results.decisions.push(hash);
            }
            let radio = &agent.participant.radio;
            results.unsent += send(number, radio, &self.command, &mut results.outbox);
        }
    }

    /// Adds the controllers of some `kinds` to the decisions that are made elsewhere, after the robots.
    pub(crate) fn request_decisions(
        &mut self,
        (scenario, state): (&Scenario, &State),
        kinds: &[u8],
        external: &mut ExternalInputs,
    ) {
        let robot_kinds = scenario.kinds.len();
        if kinds.iter().all(|kind| usize::from(*kind) < robot_kinds) {
            return;
        }
        let orders = state.orders_due(scenario);
        self.surroundings.refresh(scenario, state);
        let moment = Moment {
            scenario,
            tick: state.tick,
            body_states: &state.body_states,
            items: &state.items,
        };
        for (number, agent) in (state.agents.len()..).zip(&state.controllers) {
            let id = agent.participant.id;
            let is_free = !external.commands.contains_key(&number);
            let is_working = agent.participant.is_working(moment.body_states);
            if is_free && is_working && kinds.contains(&id.kind) {
                let controller = number - state.agents.len();
                self.perceive(
                    &moment,
                    &mut next_inputs(agent, controller, &orders, state.tick),
                );
                external.decisions.all.push(PendingDecision {
                    robot: id,
                    percept: self.percept.clone(),
                    number,
                    ..PendingDecision::default()
                });
            }
        }
    }

    /// What a controller will perceive in the next step; `None` if it does not work.
    pub(crate) fn percept(
        scenario: &Scenario,
        state: &State,
        controller: usize,
    ) -> Option<Percept> {
        let moment = Moment {
            scenario,
            tick: state.tick,
            body_states: &state.body_states,
            items: &state.items,
        };
        let mut scratch = Self::default();
        let agent = &state.controllers[controller];
        agent.participant.is_working(moment.body_states).then(|| {
            scratch.surroundings.refresh(scenario, state);
            let orders = state.orders_due(scenario);
            scratch.perceive(
                &moment,
                &mut next_inputs(agent, controller, &orders, state.tick),
            );
            scratch.percept
        })
    }

    /// Fills the percept of a controller.
    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    fn perceive(&mut self, moment: &Moment, participant: &mut Participant) {
        let Moment { scenario, tick, .. } = *moment;
        let percept = &mut self.percept;
        let time_s = tick as f64 * scenario.step_s;
        percept.time_s = Some(scenario.clocks.time_s(participant.noise, time_s));
        percept.id = participant.id;
        percept.team_size = scenario.controller_kind_of(participant.id).count;
        let words = NoisePurpose::RandomWords as u32;
        percept.random_words = participant.noise.words(words, tick, 0);
        percept.position = match participant.place {
            Place::Fixed(value, _) => Some(Reading { value, age_s: 0.0 }),
            Place::Aboard(_) => None,
        };
        percept.observations.clear();
        percept.contacts.clear();
        percept.neighbours.clear();
        let sensors = &scenario.controller_kind_of(participant.id).sensors;
        self.surroundings
            .detect(moment, participant, sensors, percept);
        percept.inbox.clear();
        participant.deliver(tick, scenario.step_s, &mut percept.inbox);
    }
}

/// A controller's participant with the `orders` of the next step, by the numbers of controllers: a copy, because its
/// messages wait until that step is taken.
fn next_inputs(
    agent: &ControllerAgent,
    controller: usize,
    orders: &[(usize, ReceivedMessage)],
    now: u64,
) -> Participant {
    let mut participant = agent.participant.clone();
    for (_, order) in orders.iter().filter(|(owner, _)| *owner == controller) {
        participant.receive_order(*order, now);
    }
    participant
}
