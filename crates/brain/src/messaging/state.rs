//! What a robot keeps for its messages, and what it sends in a step.

use super::broadcast::BroadcastState;
use super::commitment::Commitment;
use super::peers::Peers;
use super::reports::Reception;
use super::trust::Trust;
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::message::Message;
use crate::perception::beliefs::items::track::Track;
use crate::perception::beliefs::{Beliefs, BeliefsSpec};
use crate::perception::believed::BelievedItem;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of messages about items per step.
const MAX_ITEM_MESSAGES: usize = 2;

/// The memory of one robot for its messages.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Messaging {
    pub(crate) peers: Peers,
    pub(super) trust: Trust,
    broadcast: BroadcastState,
}

impl Messaging {
    /// Before the first message.
    pub(crate) fn new(spec: &BeliefsSpec, body: &Body) -> Self {
        Self {
            peers: Peers::default(),
            trust: Trust::new(&spec.trust),
            broadcast: BroadcastState::new(body.period_s),
        }
    }

    /// The items with their probabilities. A track that is probably of the item of a more probable one is none.
    pub(crate) fn believed_items(&self, beliefs: &Beliefs) -> Vec<BelievedItem> {
        let believed = beliefs.items.believed(&self.reception(beliefs.id));
        let item = |(track, confidence): (&Track, f64)| BelievedItem {
            kind: track.kind,
            at: track.at,
            deviation_m: libm::sqrt(track.variance_m2),
            confidence,
        };
        believed.into_iter().map(item).collect()
    }

    /// Renumbers the robots; information about removed robots is dropped.
    pub(crate) fn renumber(&mut self, new_id: &impl Fn(AgentId) -> Option<AgentId>) {
        let keep = |id: &mut AgentId| new_id(*id).map(|new| *id = new).is_some();
        self.peers.mates.retain_mut(|peer| keep(&mut peer.id));
        self.trust.renumber(keep);
    }

    /// Appends the messages that are due after a step of `elapsed_s` to the outbox.
    pub(crate) fn broadcast(
        &mut self,
        beliefs: &mut Beliefs,
        commitment: &Commitment,
        elapsed_s: f64,
        outbox: &mut Vec<Message>,
    ) {
        let Some(pose) = beliefs.pose() else {
            return;
        };
        let is_due = self.broadcast.is_due(beliefs.id, elapsed_s);
        let is_repeat_due = is_due && self.broadcast.is_repeat();
        if is_repeat_due {
            // First: a radio that receives too many messages receives the first of each sender.
            self.broadcast.repeat_visit(outbox);
        }
        self.broadcast
            .broadcast_goal(commitment, &pose, is_repeat_due, outbox);
        self.broadcast
            .broadcast_pose(&pose, beliefs.observations, is_due, outbox);
        if is_repeat_due {
            beliefs.items.repeat_next();
        }
        let reception = self.reception(beliefs.id);
        beliefs.items.report(&reception, outbox, MAX_ITEM_MESSAGES);
    }

    pub(super) fn reception(&self, own: AgentId) -> Reception<'_> {
        Reception {
            own,
            trust: &self.trust,
        }
    }
}
