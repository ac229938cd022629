//! Where robots stood when they were last in sight.
//!
//! A robot that is in the same place again has not moved meanwhile: it has been standing since it came there.

use super::mover::Mover;
use super::pose::Pose;
use crate::io::agent_id::AgentId;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// Maximum number of robots; beyond it, the one that has been out of sight for longest is forgotten.
const MAX_ROBOTS: usize = 16;

/// The places of robots that are out of sight, the oldest first.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct LastPlaces {
    list: Vec<LastPlace>,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct LastPlace {
    id: AgentId,
    /// In the world.
    at: Point,
    /// Time since it came there.
    standing_s: f64,
}

impl LastPlaces {
    pub(super) fn advance(&mut self, elapsed_s: f64) {
        for place in &mut self.list {
            place.standing_s += elapsed_s;
        }
    }

    /// Keeps the place of a robot that is lost from sight.
    pub(super) fn add(&mut self, mover: &Mover, pose: &Pose) {
        let Some(id) = mover.id else {
            return;
        };
        self.take(id);
        if self.list.len() == MAX_ROBOTS {
            self.list.remove(0);
        } else if self.list.len() == self.list.capacity() {
            self.list.reserve_exact(MAX_ROBOTS / 2);
        }
        self.list.push(LastPlace {
            id,
            at: pose.in_world(mover.place),
            standing_s: mover.standing_s,
        });
    }

    /// Takes the time for which a robot has been standing that comes into sight: 0 in another place.
    pub(super) fn standing_s(&mut self, mover: &Mover, pose: &Pose, noise_m: f64) -> f64 {
        let known = mover.id.and_then(|id| self.take(id));
        let at = pose.in_world(mover.at);
        let same = known.filter(|place| Mover::is_same_place(place.at, at, noise_m));
        same.map_or(0.0, |place| place.standing_s)
    }

    /// Changes the ids of the robots; those without a new id are forgotten.
    pub(super) fn renumber(&mut self, keep: impl Fn(&mut AgentId) -> bool) {
        self.list.retain_mut(|place| keep(&mut place.id));
    }

    fn take(&mut self, id: AgentId) -> Option<LastPlace> {
        let index = self.list.iter().position(|place| place.id == id)?;
        Some(self.list.remove(index))
    }
}
