//! Communication: messages are sent by radio, and wait for the brains of their receivers.

use super::decide::WorkerScratch;
use super::neighbours::Neighbours;
use super::view::View;
use crate::bodies::body_state::Status;
use crate::radio::Radio;
use crate::radio::channel::Outgoing;
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::share;
use brain::ReceivedMessage;

/// Sends the messages of all robots, each to the robots that receive it.
pub(crate) fn send(
    scenario: &Scenario,
    state: &mut State,
    neighbours: &Neighbours,
    workers: &[WorkerScratch],
) {
    if workers.iter().all(|worker| worker.outbox.is_empty()) {
        return;
    }
    let mut channel = std::mem::take(&mut state.channel);
    let (view, _) = state.view(scenario, neighbours);
    for outgoing in workers.iter().flat_map(|worker| &worker.outbox) {
        let from = outgoing.from as usize;
        if let Some(radio) = &view.kind(from).radio {
            let message = ReceivedMessage {
                from: view.ids[from],
                age_s: 0.0,
                message: outgoing.message,
            };
            let receivers = view.receivers(outgoing, radio);
            channel.send(message, (view.tick, radio.delay_steps), receivers);
        }
    }
    state.channel = channel;
}

/// Delivers the messages that arrive now.
pub(crate) fn deliver(scenario: &Scenario, state: &mut State) {
    let arrived = state.channel.arrive();
    for sent in &arrived {
        let robot = sent.to as usize;
        let kind = &scenario.kinds[usize::from(state.ids[robot].kind)];
        let is_active = state.body_states[robot].status == Status::Active;
        if let Some(radio) = kind.radio.filter(|_| is_active) {
            state.agents[robot].receive(sent, state.tick, radio.messages_per_step);
        }
    }
    state.channel.reuse(arrived);
}

impl View<'_> {
    /// The robots that receive a message, in no particular order.
    fn receivers(&self, outgoing: &Outgoing, radio: &Radio) -> impl Iterator<Item = u32> {
        let from = outgoing.from as usize;
        let near = self
            .neighbours
            .about(self.discs[from].centre, radio.range_m);
        near.filter(move |to| {
            let to = *to as usize;
            to != from && self.reaches(from, to, radio) && !self.is_lost(outgoing, to, radio)
        })
    }

    /// Whether a message from one robot reaches another, unless it is lost by chance.
    pub(crate) fn reaches(&self, from: usize, to: usize, radio: &Radio) -> bool {
        let here = self.discs[from].centre;
        let there = self.scenario.image(here, self.discs[to].centre);
        if !self.is_listening(to) || here.to(there).length_squared() > radio.range_m * radio.range_m
        {
            return false;
        }
        let layers = [from, to].map(|robot| self.kind(robot).layer);
        !radio.needs_line_of_sight || self.scenario.hiding(layers).is_open(here, there)
    }

    fn is_lost(&self, outgoing: &Outgoing, to: usize, radio: &Radio) -> bool {
        if radio.loss_probability <= 0.0 {
            return false;
        }
        let sender = self.scenario.entity(self.ids[outgoing.from as usize]);
        let used = NoisePurpose::Radio as u32 | outgoing.number << 16;
        // Steps are at most 1e8: the kind of the sender is in the unused half of their number.
        let time = u64::from(sender.kind) << 32 | self.tick;
        let words = self.noises[to].words(used, time, sender.index);
        share(words[0]) < radio.loss_probability
    }
}
