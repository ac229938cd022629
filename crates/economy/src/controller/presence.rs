//! Presence: a controller reports to others that it is in range, and which robots it sees.

use super::Controller;
use alloc::vec::Vec;
use base::geometry::Point;
use brain::{AgentId, Dispatch, Percept, Receiver, Seen};

/// Time between two messages of presence, in seconds.
const PRESENCE_PERIOD_S: f64 = 2.0;

/// Maximum number of robots whose position is reported with each message of presence.
const MAX_SEEN: usize = 4;

/// The serial number of a controller: that of its kind, then that within the kind.
fn serial(id: AgentId) -> u32 {
    u32::from(id.kind) << 24 | id.index & 0x00ff_ffff
}

impl Controller {
    /// Takes the robots that its own sensors detect into its picture; new ones are to report.
    pub(super) fn sense(&mut self, percept: &Percept) {
        for (id, at) in seen(percept) {
            let is_new = self.picture.get(id).is_none();
            self.picture.see(id, at, 1.0, self.now_s);
            if is_new && id.is_robot() {
                self.send(id, Dispatch::Query {});
            }
        }
    }

    /// Reports its presence, and the positions of robots that it sees, to other controllers.
    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn present(&mut self, percept: &Percept) {
        if self
            .colleagues
            .next_s
            .is_some_and(|next_s| self.now_s < next_s)
        {
            return;
        }
        self.colleagues.next_s = Some(self.now_s + PRESENCE_PERIOD_S);
        self.send(Receiver::All, Dispatch::Serial(serial(self.own)));
        let others = self.colleagues.list.iter();
        let others: Vec<AgentId> = others.map(|colleague| colleague.id).collect();
        for (robot, at) in seen(percept).take(MAX_SEEN) {
            let at_m = [at.x as f32, at.y as f32];
            for other in &others {
                self.send(*other, Dispatch::Seen(Seen { robot, at_m }));
            }
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
