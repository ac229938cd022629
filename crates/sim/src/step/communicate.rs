//! Communication: messages are sent by radio, and wait for the agents of their receivers.

use super::decide::WorkerScratch;
use super::neighbours::Neighbours;
use super::view::View;
use crate::bodies::Layer;
use crate::radio::channel::Outgoing;
use crate::run::agent::Agent;
use crate::run::participant::{Participant, Place};
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::geometry::Point;
use base::noise::share;
use brain::{Message, ReceivedMessage};

/// The participants of a run at the beginning of a step.
#[derive(Clone, Copy)]
pub(crate) struct Participants<'a> {
    view: &'a View<'a>,
    agents: &'a [Agent],
}

/// Sends the messages of all participants, each to those that receive it.
pub(crate) fn send(
    scenario: &Scenario,
    state: &mut State,
    neighbours: &Neighbours,
    workers: &[WorkerScratch],
) {
    let unsent = workers.iter().map(|worker| worker.unsent);
    state.tally.dropped(unsent.sum());
    if workers.iter().all(|worker| worker.outbox.is_empty()) {
        return;
    }
    let mut channel = std::mem::take(&mut state.channel);
    let (view, agents) = state.view(scenario, neighbours);
    let participants = Participants::new(&view, agents);
    for outgoing in workers.iter().flat_map(|worker| &worker.outbox) {
        if let Some(sender) = participants.get(outgoing.from) {
            let message = ReceivedMessage {
                from: sender.id,
                age_s: 0.0,
                message: outgoing.message,
            };
            let receivers = participants.receivers(outgoing, sender);
            channel.send(message, (view.tick, sender.radio.delay_steps), receivers);
        }
    }
    state.channel = channel;
}

/// Delivers the messages that arrive now.
pub(crate) fn deliver(state: &mut State) {
    let now = state.tick;
    let mut channel = std::mem::take(&mut state.channel);
    let arrived = channel.arrive();
    for sent in &arrived {
        if let Some(receiver) = receiver(state, sent.to) {
            receiver.receive(sent, now);
            channel.count(sent.to);
        }
    }
    for sent in &arrived {
        let count = channel.take_count(sent.to);
        let receiver = receiver(state, sent.to).filter(|_| count > 0);
        let dropped = receiver.map_or(0, |receiver| {
            let dropped = count.saturating_sub(receiver.radio.messages_per_step);
            if dropped > 0 {
                receiver.drop_excess(now, &mut channel.arrivals);
            }
            dropped
        });
        state.tally.dropped(dropped as u64);
    }
    channel.reuse(arrived);
    state.channel = channel;
}

/// The participant of a number, if it works.
fn receiver(state: &mut State, number: u32) -> Option<&mut Participant> {
    let robots = state.agents.len();
    let number = number as usize;
    let participant = if let Some(agent) = state.agents.get_mut(number) {
        agent.inputs.participant.as_deref_mut()
    } else {
        let controller = state.controllers.get_mut(number - robots);
        controller.map(|agent| &mut agent.participant)
    };
    participant.filter(|participant| participant.is_working(&state.body_states))
}

impl<'a> Participants<'a> {
    pub(crate) fn new(view: &'a View<'a>, agents: &'a [Agent]) -> Self {
        Self { view, agents }
    }

    /// The participant of a number; `None` for a robot without a radio.
    #[inline]
    pub(crate) fn get(&self, number: u32) -> Option<&'a Participant> {
        let number = number as usize;
        if let Some(agent) = self.agents.get(number) {
            agent.inputs.participant.as_deref()
        } else {
            let controller = self.view.controllers.get(number - self.agents.len());
            controller.map(|agent| &agent.participant)
        }
    }

    /// The participants that receive a message, in no particular order.
    fn receivers(
        &self,
        outgoing: &'a Outgoing,
        sender: &'a Participant,
    ) -> impl Iterator<Item = u32> + 'a {
        let participants = *self;
        let (here, _) = participants.place(sender);
        let view = participants.view;
        let robots = view.neighbours.about(here, sender.radio.range_m);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "participants have 32-bit numbers"
        )]
        let controllers = (view.ids.len() as u32..).take(view.controllers.len());
        robots.chain(controllers).filter(move |to| {
            let receiver = participants.get(*to).filter(|_| *to != outgoing.from);
            receiver.is_some_and(|receiver| {
                is_for(&outgoing.message, receiver)
                    && participants.reaches(sender, receiver)
                    && !is_lost(outgoing, sender, receiver, view.tick)
            })
        })
    }

    /// Whether a message of one participant reaches another, unless it is lost by chance.
    pub(crate) fn reaches(&self, from: &Participant, to: &Participant) -> bool {
        let (scenario, range_m) = (self.view.scenario, from.radio.range_m);
        let [(here, layer), (there, its_layer)] = [from, to].map(|each| self.place(each));
        let there = scenario.image(here, there);
        if !to.is_working(self.view.body_states)
            || here.to(there).length_squared() > range_m * range_m
        {
            return false;
        }
        let layers = [layer, its_layer];
        !from.radio.needs_line_of_sight || scenario.hiding(layers).is_open(here, there)
    }

    /// Whether its radio is on, and sends and receives anything.
    pub(crate) fn is_on_air(&self, participant: &Participant) -> bool {
        participant.radio.messages_per_step > 0 && participant.is_working(self.view.body_states)
    }

    fn place(&self, participant: &Participant) -> (Point, Layer) {
        match participant.place {
            Place::Aboard(robot) => {
                let robot = robot as usize;
                (self.view.discs[robot].centre, self.view.kind(robot).layer)
            }
            Place::Fixed(at, layer) => (at, layer),
        }
    }
}

/// Whether a participant is a receiver that a message names.
fn is_for(message: &Message, receiver: &Participant) -> bool {
    message.to.includes(receiver.id)
}

/// Whether a message is lost on the way to one receiver, in the step `now`.
fn is_lost(outgoing: &Outgoing, sender: &Participant, receiver: &Participant, now: u64) -> bool {
    let probability = sender.radio.loss_probability;
    if probability <= 0.0 {
        return false;
    }
    let used = NoisePurpose::Radio as u32 | outgoing.number << 16;
    // Steps are at most 1e8: the kind of the sender is in the unused half of their number.
    let time = u64::from(sender.key.kind) << 32 | now;
    let words = receiver.noise.words(used, time, sender.key.index);
    share(words[0]) < probability
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::ScenarioSpec;
    use crate::simulation::Simulation;
    use base::document::Document;
    use brain::{About, AgentId, Command, Message, Provenance, Receiver};
    use std::sync::Arc;

    const ONE: &str = "
clock = { time_limit_s = 100 }
world = { size_m = [40, 20], obstacles = [{ polygon_m = [[20, 0], [21, 0], [21, 20], [20, 20]] }] }
[robots.rover]
count = 1
radius_m = 0.2
start = { kind = \"fixed\", at_m = [[10, 10]] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
radio = { range_m = 15, needs_line_of_sight = true }
[controllers.base]
count = 1
radio = { range_m = 15, needs_line_of_sight = true }
";

    const ROVER: AgentId = AgentId::robot(0, 0);
    const CONTROLLER: AgentId = AgentId::controller(1, 0);

    /// A run with one robot at [10, 10], and a controller with the same radio.
    fn with_controller(place: Place) -> Simulation {
        let document = Document::parse("t", ONE).unwrap();
        let scenario = ScenarioSpec::read(&document).unwrap().scenario;
        let mut simulation = Simulation::new(Arc::new(scenario), 1, 0).unwrap();
        simulation.state.controllers[0].participant.place = place;
        simulation
    }

    fn message() -> Message {
        Message {
            to: Receiver::All,
            about: About::Item {
                kind: 0,
                at: Point::default(),
                provenance: Provenance::default(),
                kind_share: None,
            },
            confidence: 1.0,
        }
    }

    /// The senders of the messages that the controller has after the robot has sent one.
    fn received_at(place: Place) -> Vec<AgentId> {
        received(place, &[message()])
    }

    fn received_of(sent: &[Message]) -> Vec<AgentId> {
        received(Place::Aboard(0), sent)
    }

    fn received(place: Place, sent: &[Message]) -> Vec<AgentId> {
        let mut simulation = with_controller(place);
        let command = Command {
            outbox: sent.to_vec(),
            ..Command::default()
        };
        let commands = [(ROVER, command)].into();
        simulation.step_with([].into(), commands).unwrap();
        let inbox = &simulation.state.controllers[0].participant.inbox.entries;
        inbox.iter().map(|late| late.what.from).collect()
    }

    fn fixed(x: f64, layer: Layer) -> Place {
        Place::Fixed(Point { x, y: 10.0 }, layer)
    }

    #[test]
    fn a_controller_receives_from_robots_in_range_and_in_sight() {
        assert_eq!(received_at(fixed(15.0, Layer::Ground)), [ROVER]);
        assert_eq!(received_at(fixed(24.0, Layer::Ground)), []);
        assert_eq!(received_at(fixed(26.0, Layer::Ground)), []);
    }

    #[test]
    fn a_message_reaches_only_the_receiver_that_it_names() {
        for (to, received) in [(CONTROLLER, vec![ROVER]), (ROVER, vec![])] {
            assert_eq!(
                received_of(&[Message {
                    to: to.into(),
                    ..message()
                }]),
                received
            );
        }
    }

    #[test]
    fn a_controller_aboard_a_robot_receives_from_it() {
        assert_eq!(received_at(Place::Aboard(0)), [ROVER]);
    }

    #[test]
    fn a_robot_receives_from_a_controller() {
        let mut simulation = with_controller(fixed(15.0, Layer::Ground));
        let mut worker = WorkerScratch::default();
        worker.outbox.push(Outgoing {
            from: 1,
            number: 0,
            message: message(),
        });
        let scenario = Arc::clone(simulation.scenario());
        simulation.refresh();
        let mut neighbours = Neighbours::new(&scenario);
        let State { ids, discs, .. } = &simulation.state;
        neighbours.refresh(&scenario, ids, discs, false);
        send(&scenario, &mut simulation.state, &neighbours, &[worker]);
        deliver(&mut simulation.state);
        let percept = simulation.percept(ROVER).unwrap().unwrap();
        assert_eq!(percept.inbox[0].from, CONTROLLER);
    }
}
