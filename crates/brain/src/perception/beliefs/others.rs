//! Tracks of nearby robots and other moving objects.

use super::displacement::Displacement;
use super::last_places::LastPlaces;
use super::mover::Mover;
use super::own_path::OwnPath;
use super::pose::{Pose, turned};
use super::scan_objects::ScanObjects;
use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::percept::{Neighbour, Percept};
use crate::perception::rays::Ring;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};
use base::hashed::Hashed;

/// Maximum number of tracks.
const MAX_MOVERS: usize = 16;

/// Maximum number of neighbours that are considered per step: the nearest ones.
const MAX_NEIGHBOURS: usize = 24;

/// Tracks without an observation for this time are dropped.
const MAX_AGE_S: f64 = 1.0;

/// A hit belongs to a tracked robot if it is within its radius plus this distance.
const HIT_MARGIN_M: f64 = 0.15;

/// Gain of the velocity, for an exact and for a noisy sensor.
const EXACT_GAIN: f64 = 1.0;
const NOISY_GAIN: f64 = 0.3;

/// All tracks, in the order of their first observation; beyond [`MAX_MOVERS`], those that the robot
/// could collide with first.
///
/// They are kept in the robot's own frame and predicted by its odometry, so that collision
/// avoidance does not need a pose in the world.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Others {
    pub(crate) movers: Vec<Mover>,
    objects: ScanObjects,
    last_places: LastPlaces,
    path: OwnPath,
    /// Scratch memory, to avoid allocations.
    #[hashed(skip)]
    distances_m: Vec<f64>,
}

impl Others {
    /// Updates the tracks after a step with a displacement. Without a pose, the places of robots that are
    /// lost from sight are not kept.
    pub(crate) fn update(
        &mut self,
        percept: &Percept,
        body: &Body,
        moved: &Displacement,
        pose: Option<&Pose>,
    ) {
        let motion = moved.chord;
        self.movers.retain(|mover| mover.id.is_some());
        self.path.advance(moved);
        self.predict(motion, moved);
        self.objects
            .predict(motion, moved.turned_rad, moved.elapsed_s);
        self.last_places.advance(moved.elapsed_s);
        let max_range_m = self.max_range_m(&percept.neighbours);
        let near = percept.neighbours.iter();
        for neighbour in near.filter(|neighbour| neighbour.range_m <= max_range_m) {
            self.observe(neighbour, body, moved, pose);
        }
        self.drop_lost(pose);
        let speed_m_s = motion.length() / moved.elapsed_s.max(f64::MIN_POSITIVE);
        let stopping_m = speed_m_s * speed_m_s / (2.0 * body.max_acceleration_m_s2);
        self.keep_nearest(&Segment {
            from: Point::default(),
            to: direction(0.0).times(stopping_m.copysign(motion.x)),
        });
    }

    /// Adds moving objects of a range scan that no sensor identified as robots.
    pub(crate) fn scan(&mut self, ring: &Ring, ranges_m: &[f64]) {
        let (movers, objects) = (&self.movers, &mut self.objects);
        objects.update(ring, ranges_m, |at| is_on_any(movers, at));
        let room = MAX_MOVERS.saturating_sub(self.movers.len());
        self.movers.extend(self.objects.moving().take(room));
    }

    /// The range up to which neighbours are considered.
    fn max_range_m(&mut self, neighbours: &[Neighbour]) -> f64 {
        if neighbours.len() <= MAX_NEIGHBOURS {
            return f64::INFINITY;
        }
        self.distances_m.clear();
        let ranges_m = neighbours.iter().map(|neighbour| neighbour.range_m);
        self.distances_m.extend(ranges_m);
        let (_, max_range_m, _) = self
            .distances_m
            .select_nth_unstable_by(MAX_NEIGHBOURS, f64::total_cmp);
        *max_range_m
    }

    fn predict(&mut self, motion: Point, moved: &Displacement) {
        let back = direction(-moved.turned_rad);
        for mover in &mut self.movers {
            let drift = mover.velocity_m_s.times(moved.elapsed_s);
            mover.at = turned(motion.to(mover.at.plus(drift)), back);
            mover.velocity_m_s = turned(mover.velocity_m_s, back);
            mover.course = turned(mover.course, back);
            mover.place = turned(motion.to(mover.place), back);
            mover.standing_s += moved.elapsed_s;
            mover.age_s += moved.elapsed_s;
        }
    }

    /// Drops tracks without an observation, and keeps the places of these robots.
    fn drop_lost(&mut self, pose: Option<&Pose>) {
        let last_places = &mut self.last_places;
        self.movers.retain(|mover| {
            let is_lost = mover.age_s > MAX_AGE_S;
            if let Some(pose) = pose.filter(|_| is_lost) {
                last_places.add(mover, pose);
            }
            !is_lost
        });
    }

    fn observe(
        &mut self,
        neighbour: &Neighbour,
        body: &Body,
        own: &Displacement,
        pose: Option<&Pose>,
    ) {
        let other = body.others.get(usize::from(neighbour.id.kind));
        if other.is_some_and(|other| !other.is_in_the_way) || !is_valid(neighbour) {
            return;
        }
        // This robot has moved since the observation.
        let then = direction(neighbour.bearing_rad).times(neighbour.range_m);
        let at = if neighbour.age_s > 0.0 {
            self.path.now(then, neighbour.age_s, own)
        } else {
            then
        };
        let gain = if body.neighbour_noise_m > 0.0 {
            NOISY_GAIN
        } else {
            EXACT_GAIN
        };
        let radius_m = other.map_or(body.radius_m, |other| other.radius_m);
        let radius_m = radius_m + neighbour.uncertainty_m;
        let known = self.movers.iter_mut();
        if let Some(mover) = known
            .into_iter()
            .find(|mover| mover.id == Some(neighbour.id))
        {
            mover.correct((at, body.neighbour_noise_m), neighbour.age_s, gain);
            mover.radius_m = radius_m;
            return;
        }
        let mut mover = Mover {
            id: Some(neighbour.id),
            at,
            radius_m,
            braking_m_s2: other.map_or(body.max_acceleration_m_s2, |other| {
                other.max_acceleration_m_s2
            }),
            age_s: neighbour.age_s,
            observations: 1,
            place: at,
            ..Mover::default()
        };
        if let Some(pose) = pose {
            let noise_m = body.neighbour_noise_m;
            mover.standing_s = self.last_places.standing_s(&mover, pose, noise_m);
        }
        self.add(mover);
    }

    /// Changes the ids of the robots; those without a new id are forgotten.
    pub(crate) fn renumber(&mut self, keep: impl Fn(&mut AgentId) -> bool) {
        self.movers
            .retain_mut(|mover| mover.id.as_mut().is_none_or(&keep));
        self.last_places.renumber(keep);
    }

    fn add(&mut self, mover: Mover) {
        // A doubled capacity would exceed the bound on the memory of a brain.
        if self.movers.len() == self.movers.capacity() {
            self.movers.reserve_exact(MAX_MOVERS / 2);
        }
        self.movers.push(mover);
    }

    /// Keeps the tracks whose stopping distances come nearest to the robot's own.
    fn keep_nearest(&mut self, stopping: &Segment) {
        if self.movers.len() > MAX_MOVERS {
            let distance_m = |mover: &Mover| stopping.distance_m(mover.at) - mover.stopping_m();
            self.distances_m.clear();
            self.distances_m.extend(self.movers.iter().map(distance_m));
            let (_, max_m, _) = self
                .distances_m
                .select_nth_unstable_by(MAX_MOVERS - 1, f64::total_cmp);
            let max_m = *max_m;
            self.movers.retain(|mover| distance_m(mover) <= max_m);
            self.movers.truncate(MAX_MOVERS);
        }
    }

    /// Whether a hit, in this robot's frame, belongs to a track.
    pub(crate) fn is_on_mover(&self, at: Point) -> bool {
        is_on_any(&self.movers, at)
    }

    /// Whether a hit, in this robot's frame, belongs to a robot that is not parked, or to another
    /// moving object.
    pub(super) fn is_on_moving(&self, at: Point) -> bool {
        let mut movers = self.movers.iter();
        movers.any(|mover| !mover.is_parked() && is_on(mover, at))
    }
}

/// Whether a hit, in this robot's frame, belongs to one of the tracks.
fn is_on_any(movers: &[Mover], at: Point) -> bool {
    movers.iter().any(|mover| is_on(mover, at))
}

fn is_on(mover: &Mover, at: Point) -> bool {
    let max_m = mover.radius_m + HIT_MARGIN_M;
    mover.at.to(at).length_squared() <= max_m * max_m
}

fn is_valid(neighbour: &Neighbour) -> bool {
    let is_range = (0.0..=1e6).contains(&neighbour.range_m);
    let is_angle = neighbour.bearing_rad.abs() <= 10.0;
    let is_uncertainty = (0.0..=1e6).contains(&neighbour.uncertainty_m);
    is_range && is_angle && is_uncertainty && (0.0..=MAX_AGE_S).contains(&neighbour.age_s)
}

#[cfg(test)]
mod tests;
