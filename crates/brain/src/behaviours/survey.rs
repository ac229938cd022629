//! What searches that follow beliefs have in common: where nobody has looked, and how far that is.

use crate::goals::proposal::Destination;
use crate::io::body::Body;
use crate::navigation::path::Wavefront;
use crate::perception::beliefs::peers::Peer;
use crate::perception::beliefs::{Beliefs, Map};
use alloc::vec::Vec;
use base::geometry::Point;

/// Room beside what is filled, as a share of a cell's width.
const CELL_ROOM: f64 = 0.35;

/// It thinks again after so long, in seconds.
const AGAIN_S: f64 = 2.0;

/// A place where somebody else is going counts as much less.
const CLAIMED: f64 = 0.1;

/// So many places are given up at most: the first may then be tried again.
const MOST_GIVEN_UP: usize = 16;

/// What one robot remembers of its search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Survey {
    wavefront: Wavefront,
    /// Where it is going, and for how long it has been.
    pub(crate) going: Option<(Point, f64)>,
    /// Places that it could not get to, or need not again so soon.
    given_up: Vec<Point>,
}

impl Survey {
    /// The place that is worth most, by its cell and the way there; `None` if none is worth
    /// anything. `worth` is also told what the best so far is worth: of less it need not say how
    /// much.
    ///
    /// Nothing so far off is worth more than `at_most` of the way. Where the body does not fit, so
    /// that it can only be looked at from outside, comes last.
    pub(crate) fn best(
        &mut self,
        (map, body): (&Map, &Body),
        at: Point,
        worth: impl Fn(usize, f64, f64) -> f64,
        at_most: impl Fn(f64) -> f64,
    ) -> Option<Point> {
        let room_m = body.radius_m + CELL_ROOM * map.field.cell_m;
        let (known, given_up) = ((&map.field, &map.occupancy), &self.given_up);
        let mut best = Best::default();
        let mut offer = |cell, way_m| {
            let worth = worth(cell, way_m, best.worth);
            if worth > best.worth {
                best.offer(map.field.centre(cell), worth, given_up, map.field.cell_m);
            }
            best
        };
        self.wavefront.expand(known, at, room_m, |cell, way_m| {
            at_most(way_m) > offer(cell, way_m).worth
        });
        if best.place.is_none() {
            self.beside(map, &worth, &mut best);
        }
        best.place
    }

    /// The same among cells that the body does not fit into.
    fn beside(&self, map: &Map, worth: impl Fn(usize, f64, f64) -> f64, best: &mut Best) {
        let (field, cells) = (&map.field, 0..map.field.cells());
        for cell in cells.filter(|cell| self.wavefront.is_blocked(field, *cell)) {
            let place = field.centre(cell);
            let is_worth_it = worth(cell, 0.0, best.worth) > best.worth;
            if let Some((_, way_m)) = is_worth_it
                .then(|| self.wavefront.exit(field, &map.occupancy, place))
                .flatten()
            {
                best.offer(
                    place,
                    worth(cell, way_m, best.worth),
                    &self.given_up,
                    field.cell_m,
                );
            }
        }
    }

    /// Where it is going, unless it is time to think again.
    pub(crate) fn still_going(&mut self, period_s: f64) -> Option<Point> {
        let (to, since_s) = self.going.as_mut()?;
        *since_s += period_s;
        (*since_s < AGAIN_S).then_some(*to)
    }

    /// Not there again.
    pub(crate) fn give_up(&mut self) {
        if let Some((to, _)) = self.going.take() {
            if self.given_up.len() == MOST_GIVEN_UP {
                self.given_up.remove(0);
            }
            self.given_up.push(to);
        }
    }
}

/// The best place so far.
#[derive(Debug, Clone, Copy, Default)]
struct Best {
    worth: f64,
    place: Option<Point>,
}

impl Best {
    /// Takes a place that is worth more, unless it was given up, or one near it.
    fn offer(&mut self, place: Point, worth: f64, given_up: &[Point], near_m: f64) {
        let is_near = |other: &Point| other.to(place).length_squared() < near_m * near_m;
        if worth > self.worth && !given_up.iter().any(is_near) {
            (self.worth, self.place) = (worth, Some(place));
        }
    }
}

/// How much of what is at a place is left for this robot: others who go there, or are nearer, leave
/// little.
pub(crate) fn share(beliefs: &Beliefs, at: Point, place: Point, near_m: f64) -> f64 {
    let away = at.to(place).length_squared();
    let takes = |peer: &Peer| {
        let goes = peer
            .destination()
            .is_some_and(|destination| destination.to(place).length_squared() < near_m * near_m);
        let is_nearer = peer
            .at()
            .is_some_and(|there| there.to(place).length_squared() < away);
        goes || is_nearer
    };
    if beliefs.peers.mates.iter().any(takes) {
        CLAIMED
    } else {
        1.0
    }
}

/// How a search goes to a place.
pub(crate) fn destination(speed_m_s: Option<f64>, value: f64, body: &Body) -> Destination {
    Destination {
        at: Point::default(),
        tolerance_m: 0.3,
        max_speed_m_s: speed_m_s.unwrap_or(body.max_speed_m_s),
        value,
    }
}
