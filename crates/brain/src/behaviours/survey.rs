//! Selection of the best place to search, common to the searches that use beliefs.

use crate::goals::proposal::Destination;
use crate::io::body::Body;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::messaging::peers::{Peer, Peers};
use crate::navigation::path::Wavefront;
use crate::perception::beliefs::Map;
use crate::situation::Situation;
use alloc::vec::Vec;
use base::geometry::Point;

/// Clearance beside occupied cells, as a fraction of a cell's width.
const CELL_ROOM: f64 = 0.35;

/// Interval between selections, in seconds.
const SELECTION_PERIOD_S: f64 = 2.0;

/// Weight of a place that another robot is driving to.
const CLAIMED: f64 = 0.1;

/// Maximum number of abandoned places: beyond it, the oldest may be tried again.
const MAX_ABANDONED: usize = 16;

/// The state of one robot's search.
#[derive(Debug, Clone, Default)]
pub(crate) struct Survey {
    wavefront: Wavefront,
    /// The current destination, and the time since it was selected.
    destination: Option<(GoalPlace, f64)>,
    /// Places that were unreachable, or do not need another visit soon.
    abandoned: Vec<Point>,
}

impl Survey {
    /// The place with the highest value, by its cell and the path length; `None` if no value is
    /// positive. `value` also gets the best value found; it may return any lower value if it is
    /// not exceeded.
    ///
    /// `at_most` bounds the value by the path length. Places where the body does not fit, which can
    /// only be observed from outside, are considered last.
    pub(crate) fn best(
        &mut self,
        (map, body): (&Map, &Body),
        at: Point,
        value: impl Fn(usize, f64, f64) -> f64,
        at_most: impl Fn(f64) -> f64,
    ) -> Option<Point> {
        let room_m = body.radius_m + CELL_ROOM * map.field.cell_m;
        let (known, abandoned) = ((&map.field, &map.occupancy), &self.abandoned);
        let mut best = Best::default();
        let mut offer = |cell, way_m| {
            let value = value(cell, way_m, best.value);
            if value > best.value {
                best.offer(map.field.centre(cell), value, abandoned, map.field.cell_m);
            }
            best
        };
        self.wavefront.expand(known, at, room_m, |cell, way_m| {
            at_most(way_m) > offer(cell, way_m).value
        });
        if best.place.is_none() {
            self.beside(map, &value, &mut best);
        }
        best.place
    }

    /// The best place among cells where the body does not fit.
    fn beside(&self, map: &Map, value: impl Fn(usize, f64, f64) -> f64, best: &mut Best) {
        let (field, cells) = (&map.field, 0..map.field.cells());
        for cell in cells.filter(|cell| self.wavefront.is_blocked(field, *cell)) {
            let place = field.centre(cell);
            let is_better = value(cell, 0.0, best.value) > best.value;
            if let Some((_, way_m)) = is_better
                .then(|| self.wavefront.exit(field, &map.occupancy, place))
                .flatten()
            {
                best.offer(
                    place,
                    value(cell, way_m, best.value),
                    &self.abandoned,
                    field.cell_m,
                );
            }
        }
    }

    /// The current destination, until the next selection is due.
    pub(crate) fn current(&mut self, elapsed_s: f64) -> Option<GoalPlace> {
        let (to, since_s) = self.destination.as_mut()?;
        *since_s += elapsed_s;
        (*since_s < SELECTION_PERIOD_S).then_some(*to)
    }

    /// Selects a place as the current destination.
    pub(crate) fn select(&mut self, at: Point, situation: &Situation) -> GoalPlace {
        let previous = self.destination.map(|(to, _)| to);
        let to = situation.goal_at(at, previous);
        self.destination = Some((to, 0.0));
        to
    }

    /// Abandons the current destination.
    pub(crate) fn abandon(&mut self) {
        if let Some((to, _)) = self.destination.take() {
            if self.abandoned.len() == MAX_ABANDONED {
                self.abandoned.remove(0);
            }
            self.abandoned.push(to.at);
        }
    }
}

/// The best place found.
#[derive(Debug, Clone, Copy, Default)]
struct Best {
    value: f64,
    place: Option<Point>,
}

impl Best {
    /// Keeps a place with a higher value, unless it is near an abandoned one.
    fn offer(&mut self, place: Point, value: f64, abandoned: &[Point], near_m: f64) {
        let is_near = |other: &Point| other.to(place).length_squared() < near_m * near_m;
        if value > self.value && !abandoned.iter().any(is_near) {
            (self.value, self.place) = (value, Some(place));
        }
    }
}

/// The weight of a place for this robot: low if another robot is driving there or is nearer.
pub(crate) fn share(peers: &Peers, at: Point, place: Point, near_m: f64) -> f64 {
    let away = at.to(place).length_squared();
    let takes = |peer: &Peer| {
        let goes = peer
            .destination()
            .is_some_and(|destination| destination.at.to(place).length_squared() < near_m * near_m);
        let is_nearer = peer
            .at()
            .is_some_and(|there| there.to(place).length_squared() < away);
        goes || is_nearer
    };
    if peers.mates.iter().any(takes) {
        CLAIMED
    } else {
        1.0
    }
}

/// A search's destination, without its position.
pub(crate) fn destination(speed_m_s: Option<f64>, value: f64, body: &Body) -> Destination {
    Destination {
        id: GoalId::default(),
        at: Point::default(),
        tolerance_m: 0.3,
        max_deviation_m: f64::INFINITY,
        is_at_hazard: false,
        max_speed_m_s: speed_m_s.unwrap_or(body.max_speed_m_s),
        value,
    }
}
