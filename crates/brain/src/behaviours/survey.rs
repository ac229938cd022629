//! What searches that follow beliefs have in common: where nobody has looked, and how far that is.

use crate::beliefs::peers::Peer;
use crate::beliefs::{Beliefs, Map};
use crate::body::Body;
use crate::way::path::Wave;
use crate::wish::Aim;
use alloc::vec::Vec;
use base::geometry::Point;

/// Room beside what is filled, as a share of a cell's width.
const CELL_ROOM: f64 = 0.35;

/// It thinks again after so long, in seconds.
const AGAIN_S: f64 = 2.0;

/// A place where somebody else is going counts as much less.
const CLAIMED: f64 = 0.1;

/// What one robot remembers of its search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Survey {
    pub(crate) wave: Wave,
    /// Where it is going, and for how long it has been.
    pub(crate) going: Option<(Point, f64)>,
    /// Places that it could not get to.
    given_up: Vec<Point>,
}

impl Survey {
    /// Lets the wave run from where the robot is.
    pub(crate) fn look(&mut self, map: &Map, at: Point, body: &Body) {
        let room_m = body.radius_m + CELL_ROOM * map.field.cell_m;
        self.wave.run(&map.field, &map.filled, at, room_m);
    }

    /// Where it is going, unless it is time to think again.
    pub(crate) fn still_going(&mut self, period_s: f64) -> Option<Point> {
        let (to, since_s) = self.going.as_mut()?;
        *since_s += period_s;
        (*since_s < AGAIN_S).then_some(*to)
    }

    /// Never there again.
    pub(crate) fn give_up(&mut self) {
        if let Some((to, _)) = self.going.take() {
            self.given_up.push(to);
        }
    }

    /// Whether it tried to get near to a place in vain.
    pub(crate) fn is_given_up(&self, place: Point, near_m: f64) -> bool {
        let mut given_up = self.given_up.iter();
        given_up.any(|other| other.to(place).length_squared() < near_m * near_m)
    }
}

/// How much of what is at a place is left for this robot: others who go there, or are nearer, leave
/// little.
pub(crate) fn share(beliefs: &Beliefs, at: Point, place: Point, near_m: f64) -> f64 {
    let away = at.to(place).length_squared();
    let takes = |peer: &Peer| {
        let goes = peer
            .aim
            .is_some_and(|aim| aim.to(place).length_squared() < near_m * near_m);
        let is_nearer = peer
            .at
            .is_some_and(|(there, _)| there.to(place).length_squared() < away);
        goes || is_nearer
    };
    if beliefs.peers.fresh().any(takes) {
        CLAIMED
    } else {
        1.0
    }
}

/// How a search goes to a place.
pub(crate) fn aim(speed_m_s: Option<f64>, value: f64, body: &Body) -> Aim {
    Aim {
        to: Point::default(),
        within_m: 0.3,
        speed_m_s: speed_m_s.unwrap_or(body.max_speed_m_s),
        value,
    }
}
