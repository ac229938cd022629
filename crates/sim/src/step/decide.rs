//! Sense and decide, robot by robot: each from the same view, so that order never matters.

use super::decision::{Decision, DecisionInputs};
use super::decision_hash::{decision_hash, motion_hash};
use super::mixed_percept::{Perceived, add_virtual};
use super::sense::{SensingScratch, sense, sense_between_steps};
use super::view::View;
use crate::bodies::kind::Kind;
use crate::radio::Radio;
use crate::radio::channel::Outgoing;
use crate::run::agent::Agent;
use crate::sensors::sensor_frame::NoisePurpose;
use crate::world::items::RECOGNISED_WITHIN_M;
use base::geometry::Point;
use base::trig::sin_cos;
use brain::{About, Command, ContractMessage, Motion, Percept, Reading, Scan};

/// Buffers of one thread that lets robots decide, and the results. They are reused in each step, so
/// that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct WorkerScratch {
    pub(crate) percept: Percept,
    /// Scans that the percept of the last robot did not need.
    scans: Vec<Scan>,
    pub(crate) command: Command,
    pub(crate) sensing: SensingScratch,
    /// Messages that robots send, in their order.
    pub(crate) outbox: Vec<Outgoing>,
    /// Number of messages beyond the maximum of their radios, which are not sent, and those that report goals as done.
    pub(crate) unsent: u64,
    pub(crate) unsent_done: Vec<Outgoing>,
    /// Commands of brains for external bodies, by the number of the robot.
    pub(crate) external_commands: Vec<(usize, Command)>,
    /// What external bodies perceived, by the number of the robot.
    pub(crate) perceived: Vec<(usize, Perceived)>,
    /// The hash of each decision, in the order of the robots, if decisions are hashed.
    pub(crate) decisions: Vec<u64>,
}

impl WorkerScratch {
    pub(crate) fn clear(&mut self) {
        self.sensing.detections.clear();
        self.outbox.clear();
        self.unsent = 0;
        self.unsent_done.clear();
        self.external_commands.clear();
        self.perceived.clear();
        self.decisions.clear();
    }

    /// Lets one robot sense, and decide if its brain steps now.
    #[inline]
    pub(crate) fn serve(&mut self, inputs: &DecisionInputs, robot: usize, agent: &mut Agent) {
        let view = inputs.view;
        let decision = inputs.decision(robot);
        let perceived = match decision {
            Decision::Still => {
                agent.setpoint = Motion::default();
                return;
            }
            Decision::Nothing => {
                self.wait(view, robot, agent);
                return;
            }
            Decision::Brain => return self.serve_simulated(inputs, robot, agent),
            Decision::BrainOf(percept) => {
                self.perceive_outside(view, robot, agent, percept);
                agent.brain.step_into(&self.percept, &mut self.command);
                self.external_commands.push((robot, self.command.clone()));
                Some(&self.percept)
            }
            Decision::Command(command) => {
                let is_due = self.perceive(view, robot, agent);
                if is_due {
                    agent.brain.skip(&self.percept);
                }
                take(&mut self.command, command);
                is_due.then_some(&self.percept)
            }
            Decision::Elsewhere(decision) => {
                take(&mut self.command, &decision.command);
                Some(&decision.percept)
            }
        };
        if inputs.hashes_decisions {
            let hash = decision_hash(robot, perceived, &self.command);
            self.decisions.push(hash);
        }
        self.obey(robot, agent);
    }

    #[inline]
    fn serve_simulated(&mut self, inputs: &DecisionInputs, robot: usize, agent: &mut Agent) {
        let view = inputs.view;
        if let Some(motion) = inputs.flocks.motion(view, robot, agent) {
            agent.setpoint = motion;
            if inputs.hashes_decisions {
                self.decisions.push(motion_hash(robot, motion));
            }
        } else if self.perceive(view, robot, agent) {
            agent.brain.step_into(&self.percept, &mut self.command);
            if inputs.hashes_decisions {
                let hash = decision_hash(robot, Some(&self.percept), &self.command);
                self.decisions.push(hash);
            }
            self.obey(robot, agent);
        }
    }

    /// Lets the virtual sensors of an external body measure between two steps of its brain. One that is held
    /// or driven by hand gets nothing of that time when its brain steps again.
    fn wait(&mut self, view: &View, robot: usize, agent: &mut Agent) {
        let body = view.kind(robot).brain.body();
        let external = view.body_states[robot].external();
        let is_idle = external.is_some_and(|external| external.is_idle(body));
        match &mut agent.inputs.backlog {
            Some(backlog) if is_idle => backlog.drop_detections(),
            _ => sense_between_steps(view, robot, agent, &mut self.sensing),
        }
    }

    /// Fills the percept of an external body: what was read outside of the simulation, and what its virtual
    /// sensors measure.
    fn perceive_outside(&mut self, view: &View, robot: usize, agent: &mut Agent, read: &Percept) {
        let Some(external) = view.body_states[robot].external() else {
            return;
        };
        let mut measured = Percept::default();
        if external.virtual_sensors != 0 {
            self.clear_percept(view.kind(robot));
            sense(view, robot, agent, &mut self.sensing, &mut self.percept);
            measured.clone_from(&self.percept);
        }
        self.percept.clone_from(read);
        self.recognise(view, robot);
        if external.virtual_sensors != 0 {
            add_virtual(&mut self.percept, &measured, external, view.kind(robot));
        }
        let (now, step_s) = (view.tick, view.scenario.step_s);
        agent
            .inputs
            .deliver_messages(now, step_s, &mut self.percept);
        let perceived = Perceived {
            real: read.clone(),
            measured,
            whole: self.percept.clone(),
        };
        self.perceived.push((robot, perceived));
    }

    /// Notes the items of external contacts: the nearest item of the kind, if it is near.
    fn recognise(&mut self, view: &View, robot: usize) {
        let frame = view.sensor_frame(robot, 0, 0);
        for contact in &self.percept.contacts {
            let (y, x) = sin_cos(contact.bearing_rad);
            let place = frame.world_of(Point { x, y }.times(contact.range_m));
            let place = view.scenario.home(place);
            let near = view.items.near(place, RECOGNISED_WITHIN_M);
            let same = near.filter(|(_, item)| view.items.kind(*item) == contact.kind);
            let distances = same.map(|(at, item)| (place.to(*at).length(), *item));
            let nearest = distances.min_by(|one, other| one.0.total_cmp(&other.0));
            let nearest = nearest.filter(|(distance_m, _)| *distance_m <= RECOGNISED_WITHIN_M);
            let item = nearest.map(|(_, item)| item);
            self.sensing.detections.note(robot, item);
        }
    }

    /// Takes the measurements of a robot, and fills the percept if its brain steps now; returns
    /// whether it does.
    pub(crate) fn perceive(&mut self, view: &View, robot: usize, agent: &mut Agent) -> bool {
        let kind = view.kind(robot);
        let Some(brain_step) = kind.schedule.due(view.tick) else {
            sense_between_steps(view, robot, agent, &mut self.sensing);
            return false;
        };
        self.clear_percept(kind);
        sense(view, robot, agent, &mut self.sensing, &mut self.percept);
        let (now, step_s) = (view.tick, view.scenario.step_s);
        agent
            .inputs
            .deliver_messages(now, step_s, &mut self.percept);
        self.add_own_state(view, robot, brain_step);
        if let Some(acting) = &mut agent.inputs.acting {
            acting.deliver(&mut self.percept);
        }
        true
    }

    /// Empties the percept but keeps the capacity of its lists.
    #[inline]
    fn clear_percept(&mut self, kind: &Kind) {
        let percept = &mut self.percept;
        percept.position = None;
        percept.heading_rad = None;
        percept.motion = None;
        percept.battery = None;
        percept.touch = None;
        percept.observations.clear();
        percept.contacts.clear();
        percept.neighbours.clear();
        percept.inbox.clear();
        percept.acted.clear();
        percept.charges = None;
        let rings = kind.brain.body().rings.len();
        // Kinds have different numbers of rings.
        while percept.scans.len() > rings {
            self.scans.extend(percept.scans.pop());
        }
        while percept.scans.len() < rings {
            percept.scans.push(self.scans.pop().unwrap_or_default());
        }
        for scan in &mut percept.scans {
            scan.age_s = None;
            scan.ranges_m.clear();
        }
    }

    /// Adds the robot's own state to the percept.
    fn add_own_state(&mut self, view: &View, robot: usize, brain_step: u64) {
        let (body_state, kind) = (&view.body_states[robot], view.kind(robot));
        let percept = &mut self.percept;
        percept.time_s = Some(view.time_s(robot));
        percept.id = view.ids[robot];
        percept.team_size = view.kind(robot).count;
        percept.random_words =
            view.noises[robot].words(NoisePurpose::RandomWords as u32, brain_step, 0);
        percept.touch = now(body_state.is_pressed);
        let odometry = kind.drive.has_odometry.then(|| body_state.motion());
        percept.motion = odometry.and_then(now);
        percept.battery = body_state.charge(kind).and_then(now);
    }

    /// Applies the command to the agent.
    #[inline]
    fn obey(&mut self, robot: usize, agent: &mut Agent) {
        agent.setpoint = self.command.motion;
        for request in &self.command.requests {
            agent.switch(*request);
        }
        if let Some(acting) = &mut agent.inputs.acting {
            acting.command(&self.command.acts);
        }
        if let Some(participant) = &agent.inputs.participant {
            let radio = &participant.radio;
            self.unsent += send(robot, radio, &self.command, &mut self.outbox);
            let unsent = numbered(robot, &self.command).skip(radio.messages_per_step);
            self.unsent_done.extend(unsent.filter(is_done_of_contract));
        }
    }
}

/// Takes over a decision that was made elsewhere.
fn take(own: &mut Command, command: &Command) {
    own.motion = command.motion;
    own.heading_rad = command.heading_rad;
    own.requests.clone_from(&command.requests);
    own.outbox.clone_from(&command.outbox);
    own.acts.clone_from(&command.acts);
}

/// Adds the messages of a participant to those that are sent, up to the maximum of its radio; returns the number of the
/// others.
pub(super) fn send(
    number: usize,
    radio: &Radio,
    command: &Command,
    outbox: &mut Vec<Outgoing>,
) -> u64 {
    outbox.extend(numbered(number, command).take(radio.messages_per_step));
    let unsent = command.outbox.len().saturating_sub(radio.messages_per_step);
    unsent as u64
}

/// The messages of a command.
#[expect(
    clippy::cast_possible_truncation,
    reason = "participants have 32-bit numbers"
)]
fn numbered(number: usize, command: &Command) -> impl Iterator<Item = Outgoing> {
    let messages = command.outbox.iter().zip(0..);
    messages.map(move |(message, place)| Outgoing {
        from: number as u32,
        number: place,
        message: *message,
    })
}

fn is_done_of_contract(outgoing: &Outgoing) -> bool {
    let about = &outgoing.message.about;
    matches!(about, About::Contract(ContractMessage::Done(_)))
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "a reading that is always there, among those that may not be"
)]
fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}
