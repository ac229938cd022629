//! Robots nearby, and what else moves.

use super::mover::Mover;
use super::moving::Things;
use super::pose::turned;
use crate::io::body::Body;
use crate::io::percept::{Neighbour, Percept};
use crate::perception::rays::Ring;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};

/// So many are kept in mind.
const MOST: usize = 16;

/// Of a throng so many are looked at.
const MOST_AT_ONCE: usize = 24;

/// Who has not been seen for so long is forgotten, in seconds.
const FORGOTTEN_S: f64 = 1.0;

/// Something is on a robot that is known if it is no farther from it than this, besides its radius.
const ON_IT_M: f64 = 0.15;

/// Of an exact sensor, a new velocity counts so much; of one that errs, less.
const EXACT: f64 = 1.0;
const NOISY: f64 = 0.3;

/// All of them, in the order in which they were first seen; of more than [`MOST`], those that it could
/// soonest run into.
///
/// They are kept in the robot's own frame and carried along by what it moves, so that nobody needs to
/// know where in the world he is to keep out of others' way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Others {
    pub(crate) movers: Vec<Mover>,
    things: Things,
    /// Kept so that nothing is allocated.
    away_m: Vec<f64>,
}

impl Others {
    /// Takes in a step in which the robot went `way` (from its front as it was) and turned.
    pub(crate) fn take_in(&mut self, percept: &Percept, body: &Body, way: Point, turned_rad: f64) {
        self.movers.retain(|mover| mover.id.is_some());
        self.carry_on(body.period_s, way, turned_rad);
        self.things.pass(way, turned_rad, body.period_s);
        let near_m = self.near_m(&percept.neighbours);
        let near = percept.neighbours.iter();
        for neighbour in near.filter(|neighbour| neighbour.range_m <= near_m) {
            self.see(neighbour, body, turned_rad);
        }
        self.movers.retain(|mover| mover.age_s <= FORGOTTEN_S);
        let speed_m_s = way.length() / body.period_s.max(f64::MIN_POSITIVE);
        let stopping_m = speed_m_s * speed_m_s / (2.0 * body.max_acceleration_m_s2);
        self.keep_nearest(&Segment {
            from: Point::default(),
            to: direction(0.0).times(stopping_m.copysign(way.x)),
        });
    }

    /// Takes in a scan, of what moves and no sensor knows for a robot.
    pub(crate) fn scan(&mut self, ring: &Ring, ranges_m: &[f64]) {
        let (movers, things) = (&self.movers, &mut self.things);
        things.see(ring, ranges_m, |at| is_on_one_of(movers, at));
        let room = MOST.saturating_sub(self.movers.len());
        self.movers.extend(self.things.moving().take(room));
    }

    /// Of a throng only the nearest are looked at.
    fn near_m(&mut self, neighbours: &[Neighbour]) -> f64 {
        if neighbours.len() <= MOST_AT_ONCE {
            return f64::INFINITY;
        }
        self.away_m.clear();
        let ranges_m = neighbours.iter().map(|neighbour| neighbour.range_m);
        self.away_m.extend(ranges_m);
        let (_, near_m, _) = self
            .away_m
            .select_nth_unstable_by(MOST_AT_ONCE, f64::total_cmp);
        *near_m
    }

    fn carry_on(&mut self, period_s: f64, way: Point, turned_rad: f64) {
        let back = direction(-turned_rad);
        for mover in &mut self.movers {
            let moved = mover.velocity_m_s.times(period_s);
            mover.at = turned(way.to(mover.at.plus(moved)), back);
            mover.velocity_m_s = turned(mover.velocity_m_s, back);
            mover.course = turned(mover.course, back);
            mover.age_s += period_s;
        }
    }

    fn see(&mut self, neighbour: &Neighbour, body: &Body, turned_rad: f64) {
        let other = body.others.get(usize::from(neighbour.id.kind));
        if other.is_some_and(|other| !other.is_in_the_way) || !is_sensible(neighbour) {
            return;
        }
        // Since it was seen, this robot has turned on.
        let since_rad = turned_rad / body.period_s.max(f64::MIN_POSITIVE) * neighbour.age_s;
        let at = direction(neighbour.bearing_rad - since_rad).times(neighbour.range_m);
        let share = if body.neighbour_noise_m > 0.0 {
            NOISY
        } else {
            EXACT
        };
        let known = self.movers.iter_mut();
        match known
            .into_iter()
            .find(|mover| mover.id == Some(neighbour.id))
        {
            Some(mover) => mover.correct(at, neighbour.age_s, share),
            None => self.movers.push(Mover {
                id: Some(neighbour.id),
                at,
                velocity_m_s: Point::default(),
                course: Point::default(),
                radius_m: other.map_or(body.radius_m, |other| other.radius_m),
                braking_m_s2: other.map_or(body.max_acceleration_m_s2, |other| {
                    other.max_acceleration_m_s2
                }),
                age_s: neighbour.age_s,
                observations: 1,
            }),
        }
    }

    /// Keeps those whose stopping ways come nearest to its own.
    fn keep_nearest(&mut self, stopping: &Segment) {
        if self.movers.len() > MOST {
            let away_m = |mover: &Mover| stopping.distance_m(mover.at) - mover.stopping_m();
            self.away_m.clear();
            self.away_m.extend(self.movers.iter().map(away_m));
            let (_, most_m, _) = self.away_m.select_nth_unstable_by(MOST - 1, f64::total_cmp);
            let most_m = *most_m;
            self.movers.retain(|mover| away_m(mover) <= most_m);
            self.movers.truncate(MOST);
        }
    }
}

impl Others {
    /// Whether what is seen at a place, from this robot's front, is one of them.
    pub(crate) fn is_on_one(&self, at: Point) -> bool {
        is_on_one_of(&self.movers, at)
    }
}

/// Whether what is seen at a place, from this robot's front, is one of them.
fn is_on_one_of(movers: &[Mover], at: Point) -> bool {
    movers.iter().any(|mover| {
        let near_m = mover.radius_m + ON_IT_M;
        mover.at.to(at).length_squared() <= near_m * near_m
    })
}

fn is_sensible(neighbour: &Neighbour) -> bool {
    let is_near = (0.0..=1e6).contains(&neighbour.range_m);
    let is_angle = neighbour.bearing_rad.abs() <= 10.0;
    is_near && is_angle && (0.0..=FORGOTTEN_S).contains(&neighbour.age_s)
}

#[cfg(test)]
mod tests;
