//! What moves, told from what stands by its distance: that of a thing that stands falls no faster than the
//! robot goes towards it.
//!
//! A thing is what stands before its surroundings in a scan and is no wider than [`WIDEST_M`]: along a wall
//! the nearest place moves as the robot does, so that no wall is told from a thing that keeps up. Only the
//! distance is measured well, so a thing is believed to come straight on, or to go straight off.

use super::mover::Mover;
use super::pose::turned;
use crate::perception::rays::{Ray, Ring};
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;

/// Rays whose ranges differ by less end on the same thing, in metres.
const SAME_M: f64 = 0.5;

/// Nothing wider is taken for a thing that could move, in metres.
const WIDEST_M: f64 = 1.5;

/// A thing is one that was seen before if it is no farther from where that would be now, in metres.
const AGAIN_M: f64 = 0.5;

/// A new rate of fall counts so much, and is at most so fast in m/s: ranges err, and jump where another ray
/// meets the thing than before.
const SHARE: f64 = 0.08;
const FASTEST_M_S: f64 = 1.5;

/// So often is a thing looked at before it is believed to move, and at least so fast it does, in m/s.
const LOOKS: u32 = 12;
const MOVES_M_S: f64 = 0.3;

/// Who has not been seen for so long is forgotten, in seconds.
const FORGOTTEN_S: f64 = 0.5;

/// So many things are kept in mind.
const MOST: usize = 16;

/// Something that stands or moves.
#[derive(Debug, Clone, Copy)]
struct Thing {
    /// From this robot's front, if it stands.
    at: Point,
    radius_m: f64,
    /// How fast its distance falls more than this robot goes towards it.
    falls_m_s: f64,
    observations: u32,
    age_s: f64,
}

/// All things in view, in this robot's own frame.
#[derive(Debug, Clone, Default)]
pub(crate) struct Things {
    things: Vec<Thing>,
}

impl Things {
    /// Takes in a step in which the robot went `way` (from its front as it was) and turned.
    pub(crate) fn pass(&mut self, way: Point, turned_rad: f64, period_s: f64) {
        let back = direction(-turned_rad);
        for thing in &mut self.things {
            thing.at = turned(way.to(thing.at), back);
            thing.age_s += period_s;
        }
        self.things.retain(|thing| thing.age_s <= FORGOTTEN_S);
    }

    /// Takes in a scan; what is known is left to those who know it.
    pub(crate) fn see(&mut self, ring: &Ring, ranges_m: &[f64], is_known: impl Fn(Point) -> bool) {
        let mut edges = Edges::default();
        for ray in ring.rays(ranges_m) {
            self.meet(edges.next(ray), &is_known);
        }
        if !ring.is_round() {
            return;
        }
        // What began before the first ray ends behind it.
        for ray in ring.rays(ranges_m) {
            if edges.nearest.is_none() {
                return;
            }
            self.meet(edges.next(ray), &is_known);
        }
    }

    fn meet(&mut self, thing: Option<(Ray, f64)>, is_known: impl Fn(Point) -> bool) {
        if let Some((nearest, width_m)) = thing
            && width_m <= WIDEST_M
            && !is_known(nearest.end())
        {
            self.note(&nearest, width_m / 2.0);
        }
    }

    /// Notes a thing that is nearest along a ray.
    fn note(&mut self, ray: &Ray, radius_m: f64) {
        let at = ray.end();
        let is_it = |thing: &Thing| thing.age_s > 0.0 && thing.at.to(at).length() <= AGAIN_M;
        let known = self.things.iter().position(is_it);
        if let Some(thing) = known.map(|place| &mut self.things[place]) {
            let rate_m_s = (thing.at.length() - ray.range_m) / thing.age_s;
            let rate_m_s = rate_m_s.clamp(-FASTEST_M_S, FASTEST_M_S);
            thing.falls_m_s += SHARE * (rate_m_s - thing.falls_m_s);
            thing.observations = thing.observations.saturating_add(1);
            (thing.at, thing.radius_m, thing.age_s) = (at, radius_m, 0.0);
        } else if self.things.len() < MOST {
            self.things.push(Thing {
                at,
                radius_m,
                falls_m_s: 0.0,
                observations: 1,
                age_s: 0.0,
            });
        }
    }

    /// Those that are believed to move.
    pub(crate) fn moving(&self) -> impl Iterator<Item = Mover> {
        let moves =
            |thing: &&Thing| thing.observations >= LOOKS && thing.falls_m_s.abs() >= MOVES_M_S;
        self.things.iter().filter(moves).map(|thing| {
            let away_m = thing.at.length().max(f64::MIN_POSITIVE);
            let towards = thing.at.times(-1.0 / away_m);
            Mover {
                id: None,
                at: thing.at,
                velocity_m_s: towards.times(thing.falls_m_s),
                course: towards.times(thing.falls_m_s.signum()),
                radius_m: thing.radius_m,
                braking_m_s2: f64::INFINITY,
                age_s: thing.age_s,
                observations: thing.observations,
            }
        })
    }
}

/// What stands before its surroundings in a scan, ray by ray.
#[derive(Debug, Default)]
struct Edges {
    before: Option<Ray>,
    /// Of a thing whose other edge is still to come: its first ray, and the nearest.
    first: Option<Ray>,
    nearest: Option<Ray>,
}

impl Edges {
    /// Takes in the next ray; the nearest place and the width of a thing that ends before it.
    fn next(&mut self, ray: Ray) -> Option<(Ray, f64)> {
        let before = self.before.replace(ray)?;
        let jump_m = ray.range_m - before.range_m;
        if jump_m < -SAME_M {
            (self.first, self.nearest) = (Some(ray), Some(ray));
        } else if jump_m > SAME_M {
            let width_m = self.first.take()?.end().to(before.end()).length();
            return Some((self.nearest.take()?, width_m));
        } else if let Some(nearest) = self.nearest.as_mut()
            && ray.range_m < nearest.range_m
        {
            *nearest = ray;
        }
        None
    }
}
