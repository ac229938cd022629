//! The other controllers, as far as they are in range.

use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::AgentId;

/// A controller is out of range when nothing has been received of it for this time, in seconds.
const LIFE_S: f64 = 8.0;

/// The other controllers in range.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Peers {
    pub(super) list: Vec<Peer>,
}

#[derive(Debug, Clone, Copy, Hashed)]
pub(super) struct Peer {
    pub(super) id: AgentId,
    received_s: f64,
    /// The expected number of mines of a lane that its goals may still find or destroy, once it has reported it.
    lane_gain: LaneGain,
}

/// What the goals of another controller may still find or destroy of a lane.
#[derive(Debug, Clone, Copy, Default)]
struct LaneGain(Option<f64>);

/// Controllers without a lane have the hash that they had before there were lanes.
impl Hashed for LaneGain {
    fn add_to(&self, hash: &mut Hash) {
        if let Some(gain) = self.0 {
            gain.add_to(hash);
        }
    }
}

impl Peers {
    pub(super) fn note(&mut self, id: AgentId, now_s: f64) {
        let known = self.list.iter().position(|peer| peer.id == id);
        let known = known.map(|index| self.list.remove(index));
        self.list.push(Peer {
            id,
            received_s: now_s,
            lane_gain: known.map(|peer| peer.lane_gain).unwrap_or_default(),
        });
    }

    /// Takes what the goals of another controller in range may still find or destroy of a lane.
    pub(super) fn note_lane_gain(&mut self, id: AgentId, gain: f64) {
        let mut list = self.list.iter_mut();
        if let Some(peer) = list.find(|peer| peer.id == id) {
            peer.lane_gain = LaneGain(Some(gain).filter(|gain| *gain >= 0.0));
        }
    }

    /// Those of the same kind: they vote for each other, and share a lane.
    pub(super) fn members_of(&self, own: AgentId) -> impl Iterator<Item = AgentId> {
        let same = self
            .list
            .iter()
            .filter(move |other| other.id.kind == own.kind);
        same.map(|peer| peer.id)
    }

    /// What the goals of those that share a lane may still find or destroy; infinite until all have reported it.
    pub(super) fn lane_gain(&self, own: AgentId) -> f64 {
        let same = self.list.iter().filter(|other| other.id.kind == own.kind);
        let gains = same.map(|peer| peer.lane_gain.0.unwrap_or(f64::INFINITY));
        gains.sum()
    }

    pub(super) fn expire(&mut self, now_s: f64) {
        let is_near = |peer: &Peer| now_s < peer.received_s + LIFE_S;
        self.list.retain(is_near);
    }

    /// The turn of a controller among those in range that share a lane, and the number of turns.
    pub(super) fn turn(&self, own: AgentId) -> (u32, u32) {
        let (before, after): (Vec<AgentId>, Vec<AgentId>) =
            self.members_of(own).partition(|id| *id < own);
        let count = |ids: &[AgentId]| u32::try_from(ids.len()).unwrap_or(u32::MAX);
        let turn = count(&before);
        (turn, turn.saturating_add(count(&after)).saturating_add(1))
    }
}
