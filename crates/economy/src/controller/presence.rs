//! Presence: a controller reports to others that it is in range, and which robots it sees.

use super::context::Context;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{AgentId, ContractMessage, OwnershipMessage, Percept, Receiver, Seen};

/// Time between two messages of presence, in seconds.
const PERIOD_S: f64 = 2.0;

/// Maximum number of robots whose position is reported with each message of presence.
const MAX_SEEN: usize = 4;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Presence {
    /// When the next message is due; at once without it.
    next_s: Option<f64>,
}

impl Presence {
    /// Takes the robots that its own sensors detect, and reports when it is time.
    pub(super) fn step(&mut self, context: &mut Context, percept: &Percept) {
        sense(context, percept);
        if self.next_s.is_none_or(|next_s| context.now_s >= next_s) {
            self.next_s = Some(context.now_s + PERIOD_S);
            report(context, percept);
        }
    }
}

/// Notes where robots are seen; new ones are to report.
fn sense(context: &mut Context, percept: &Percept) {
    for (id, at) in seen(percept) {
        let is_new = context.robots.get(id).is_none();
        context.robots.see(id, at, 1.0, context.now_s);
        if is_new && id.is_robot() {
            context.send(id, ContractMessage::Query {});
        }
    }
}

/// Reports its presence to all, and to its peers the positions of the robots that it sees.
#[expect(clippy::cast_possible_truncation, reason = "messages are short")]
fn report(context: &mut Context, percept: &Percept) {
    context.send(Receiver::All, OwnershipMessage::Present {});
    let peers: Vec<AgentId> = context.peers.list.iter().map(|peer| peer.id).collect();
    for (robot, at) in seen(percept).take(MAX_SEEN) {
        let at_m = [at.x as f32, at.y as f32];
        for peer in &peers {
            context.send(*peer, OwnershipMessage::Seen(Seen { robot, at_m }));
        }
    }
}

/// The robots that its sensors detect, and their positions in the world.
fn seen(percept: &Percept) -> impl Iterator<Item = (AgentId, Point)> {
    let own = percept.position.map(|position| position.value);
    let heading_rad = percept.heading_rad.map_or(0.0, |heading| heading.value);
    percept.neighbours.iter().filter_map(move |neighbour| {
        let towards_rad = heading_rad + neighbour.bearing_rad;
        let way = Point {
            x: libm::cos(towards_rad),
            y: libm::sin(towards_rad),
        };
        Some((neighbour.id, own?.plus(way.times(neighbour.range_m))))
    })
}
