//! The deciding part of a robot: its brain, its motion setpoint, and its inputs.

use super::acting::Acting;
use super::participant::{Participant, Place};
use crate::bodies::drive::delay::SetpointQueue;
use crate::bodies::kind::Kind;
use crate::sensors::backlog::Backlog;
use base::noise::Noise;
use brain::{AgentId, Brain, Motion, Percept, SensorRequest};
use std::collections::BTreeMap;

/// The deciding part of one robot.
#[derive(Debug, Clone)]
pub(crate) struct Agent {
    pub(crate) brain: Brain,
    /// The motion setpoint until the brain steps again.
    pub(crate) setpoint: Motion,
    /// The setpoints of the last steps, if its drive has a lag or a delay.
    pub(crate) queue: Option<Box<SetpointQueue>>,
    /// A bit for each sensor that is switched off.
    pub(crate) sensors_off: u32,
    pub(crate) inputs: Inputs,
}

/// What reaches the brain of a robot later than it is measured or sent. Most kinds of robots have
/// nothing of it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Inputs {
    /// Readings that have not reached the brain.
    pub(crate) backlog: Option<Box<Backlog>>,
    /// The robot as a participant in communication, if it has a radio.
    pub(crate) participant: Option<Box<Participant>>,
    /// What it does with its tools, if it has any.
    pub(crate) acting: Option<Box<Acting>>,
}

impl Agent {
    /// The agent of the robot of a number, which is the `index`th of its kind.
    pub(crate) fn new(kind: &Kind, id: AgentId, number: usize, noise: Noise) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "robots have 32-bit numbers"
        )]
        let place = Place::Aboard(number as u32);
        let draws = (kind.entity(id.index), noise);
        let participant = |radio| Box::new(Participant::new(id, place, radio, draws));
        Self {
            brain: kind.brain.clone(),
            setpoint: Motion::default(),
            queue: queue(kind, Motion::default()),
            sensors_off: 0,
            inputs: Inputs {
                backlog: kind
                    .needs_backlog()
                    .then(|| Box::new(Backlog::new(&kind.sensors))),
                participant: kind.radio.map(participant),
                acting: Acting::new(kind),
            },
        }
    }

    /// Queues the setpoint of this step, if the drive has a lag or a delay.
    #[inline]
    pub(crate) fn queue_setpoint(&mut self) {
        if let Some(queue) = &mut self.queue {
            queue.push(self.setpoint);
        }
    }

    /// The setpoints that the drive executes in this step, one after the other.
    #[inline]
    pub(crate) fn setpoints_in_force(&self) -> [Motion; 2] {
        let queue = self.queue.as_ref();
        queue.map_or([self.setpoint; 2], |queue| queue.in_force())
    }

    /// Takes over the setpoints that the drive has not executed from the agent before.
    pub(crate) fn take_over_queue(&mut self, before: &Self, kind: &Kind) {
        self.queue = queue(kind, before.setpoint);
        if let Some((now, before)) = self.queue.as_mut().zip(before.queue.as_ref()) {
            now.take_over(before);
        }
    }

    pub(crate) fn switch(&mut self, request: SensorRequest) {
        let bit = 1_u32.checked_shl(request.sensor.into()).unwrap_or(0);
        if request.on {
            self.sensors_off &= !bit;
        } else {
            self.sensors_off |= bit;
        }
    }

    /// Takes over the memory, the setpoint and the inputs of an agent that had the same brain and
    /// sensors. Radio and place stay its own.
    pub(crate) fn take_over(&mut self, before: &Self) {
        self.brain = before.brain.rebriefed(&self.brain);
        self.setpoint = before.setpoint;
        self.sensors_off = before.sensors_off;
        self.inputs.backlog.clone_from(&before.inputs.backlog);
        if let Some((now, before)) = self
            .inputs
            .acting
            .as_mut()
            .zip(before.inputs.acting.as_ref())
        {
            now.take_over(before);
        }
        if let Some((now, before)) = self
            .inputs
            .participant
            .as_mut()
            .zip(before.inputs.participant.as_ref())
        {
            now.inbox.clone_from(&before.inbox);
        }
    }

    /// Renumbers items; detections of items that were removed are dropped.
    pub(crate) fn renumber_items(&mut self, numbers: &BTreeMap<usize, usize>) {
        if let Some(backlog) = &mut self.inputs.backlog {
            backlog.contacts.entries.retain_mut(|late| {
                let Some(item) = &mut late.what.1 else {
                    return true;
                };
                let number = numbers.get(&(*item as usize));
                let number = number.and_then(|number| u32::try_from(*number).ok());
                number.inspect(|number| *item = *number).is_some()
            });
        }
    }

    /// Renumbers robots; detections and messages of robots that were removed are dropped.
    pub(crate) fn renumber_robots(&mut self, numbers: &BTreeMap<AgentId, AgentId>) {
        self.brain.renumber(|id| numbers.get(&id).copied());
        if let Some(backlog) = &mut self.inputs.backlog {
            let renumber = |id: &mut AgentId| numbers.get(id).map(|now| *id = *now).is_some();
            let neighbours = &mut backlog.neighbours.entries;
            neighbours.retain_mut(|late| renumber(&mut late.what.id));
        }
        if let Some(participant) = &mut self.inputs.participant {
            participant.renumber(numbers);
        }
    }
}

impl Inputs {
    /// Adds received messages to a percept.
    pub(crate) fn deliver_messages(&mut self, now: u64, step_s: f64, to: &mut Percept) {
        if let Some(participant) = &mut self.participant {
            participant.deliver(now, step_s, &mut to.inbox);
        }
    }
}

/// The setpoints that the drive of a robot keeps, if this was the one in all steps so far.
fn queue(kind: &Kind, setpoint: Motion) -> Option<Box<SetpointQueue>> {
    let queue = kind.drive.errors?.queue(setpoint);
    queue.map(Box::new)
}

/// Whether a sensor is on, by the bits of those that are off.
pub(crate) fn is_on(sensors_off: u32, sensor: usize) -> bool {
    sensors_off & (1 << sensor) == 0
}
