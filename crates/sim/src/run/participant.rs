//! Participants: what sends and receives messages, and can be addressed.
//!
//! Participants are numbered: first all robots, also those without a radio, and then the controllers,
//! which have no body. Radio and delivery use nothing else of a run.

use crate::bodies::Layer;
use crate::bodies::body_state::{BodyState, Status};
use crate::radio::Radio;
use crate::radio::arrivals::Arrivals;
use crate::radio::channel::Transmission;
use crate::sensors::backlog::age_s;
use crate::sensors::pending::{Pending, PendingQueue};
use crate::sensors::sensor_frame::NoisePurpose;
use base::geometry::Point;
use base::noise::Noise;
use base::random::Entity;
use brain::{AgentId, ReceivedMessage};
use std::collections::BTreeMap;

/// A participant in communication: a robot that has a radio, or a controller.
#[derive(Debug, Clone)]
pub(crate) struct Participant {
    pub(crate) id: AgentId,
    pub(crate) place: Place,
    pub(crate) radio: Radio,
    /// Its key in the random streams of other participants.
    pub(crate) key: Entity,
    pub(crate) noise: Noise,
    /// Whether it is silent for ever, though not because of a robot that carries it.
    pub(crate) has_failed: bool,
    /// Received messages that its agent has not read.
    pub(crate) inbox: PendingQueue<ReceivedMessage>,
}

/// Where a participant is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Aboard the robot of this number: it works only while the robot does.
    Aboard(u32),
    /// At a fixed point. Obstacles hide it as they hide robots of the layer.
    Fixed(Point, Layer),
}

impl Participant {
    /// A participant of a run without any messages; `key` is its key in random streams.
    pub(crate) fn new(
        id: AgentId,
        place: Place,
        radio: Radio,
        (key, noise): (Entity, Noise),
    ) -> Self {
        Self {
            id,
            place,
            radio,
            key,
            noise,
            has_failed: false,
            inbox: PendingQueue::default(),
        }
    }

    /// Whether it can send and receive at all.
    pub(crate) fn is_working(&self, body_states: &[BodyState]) -> bool {
        let is_carried = match self.place {
            Place::Aboard(robot) => body_states[robot as usize].status == Status::Active,
            Place::Fixed(..) => true,
        };
        is_carried && !self.has_failed
    }

    /// Receives a message that arrives now.
    pub(crate) fn receive(&mut self, sent: &Transmission, now: u64) {
        self.inbox.forget(now);
        self.inbox.entries.push(Pending {
            taken: sent.at,
            due: now,
            what: sent.message,
        });
    }

    /// Drops the messages that arrived in this step beyond the maximum of the radio; `arrivals` is
    /// scratch.
    pub(crate) fn drop_excess(&mut self, now: u64, arrivals: &mut Arrivals) {
        let entries = &mut self.inbox.entries;
        let earlier = entries.iter().rev().take_while(|late| late.due == now);
        let first = entries.len() - earlier.count();
        let selected = arrivals.select(
            &entries[first..],
            (self.id, self.radio.messages_per_step),
            |from| {
                // Steps are at most 1e8: the kind is in the unused half of their number.
                let time = u64::from(from.kind) << 32 | now;
                self.noise
                    .words(NoisePurpose::Inbox as u32, time, from.index)[0]
            },
        );
        for (place, arrival) in selected.iter().enumerate() {
            entries[first + place] = entries[first + arrival.place];
        }
        entries.truncate(first + selected.len());
    }

    /// Receives a message of a person, without a radio.
    pub(crate) fn receive_order(&mut self, message: ReceivedMessage, now: u64) {
        self.inbox.entries.push(Pending {
            taken: now,
            due: now,
            what: message,
        });
    }

    /// Passes the messages that have arrived to the inbox of a percept.
    pub(crate) fn deliver(&mut self, now: u64, step_s: f64, inbox: &mut Vec<ReceivedMessage>) {
        self.inbox.deliver(now, |late| {
            let age_s = age_s(late.taken, now, step_s);
            inbox.push(ReceivedMessage { age_s, ..late.what });
        });
    }

    /// Renumbers the senders of its messages; those of participants that were removed are dropped.
    pub(crate) fn renumber(&mut self, numbers: &BTreeMap<AgentId, AgentId>) {
        let renumber = |id: &mut AgentId| {
            *id == AgentId::OPERATOR || numbers.get(id).map(|now| *id = *now).is_some()
        };
        let inbox = &mut self.inbox.entries;
        inbox.retain_mut(|late| renumber(&mut late.what.from));
    }
}
