//! Moving objects in range scans, distinguished from static ones by their range rate: the range of
//! a static object decreases no faster than the robot approaches it.
//!
//! An object is a foreground segment of a scan that is no wider than [`MAX_WIDTH_M`]: the nearest
//! point of a wall moves with the robot, so that walls cannot be distinguished from objects that
//! keep pace. Only the range is measured precisely; objects are therefore assumed to move straight
//! towards the robot or away.

use super::mover::Mover;
use super::pose::turned;
use crate::perception::rays::{Ray, Ring};
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// Neighbouring rays belong to the same object if their ranges differ by less.
const SAME_OBJECT_M: f64 = 0.5;

/// Maximum width of an object that could move.
const MAX_WIDTH_M: f64 = 1.5;

/// Maximum distance of an observation from the predicted position of a known object.
const ASSOCIATION_M: f64 = 0.5;

/// Gain and limit of a new closing speed: ranges are noisy, and jump when a different ray meets the
/// object.
const GAIN: f64 = 0.08;
const MAX_CLOSING_M_S: f64 = 1.5;

/// Minimum number of observations and minimum closing speed of an object that counts as moving.
const MIN_OBSERVATIONS: u32 = 12;
const MIN_CLOSING_M_S: f64 = 0.3;

/// Objects without an observation for this time are dropped.
const MAX_AGE_S: f64 = 0.5;

/// Maximum number of objects.
const MAX_OBJECTS: usize = 16;

/// A static or moving object.
#[derive(Debug, Clone, Copy, Hashed)]
struct ScanObject {
    /// Position in this robot's frame, if it is static.
    at: Point,
    radius_m: f64,
    /// Closing speed beyond that of this robot's own motion.
    closing_m_s: f64,
    observations: u32,
    age_s: f64,
}

/// All objects in view, in this robot's frame.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct ScanObjects {
    objects: Vec<ScanObject>,
}

impl ScanObjects {
    /// Predicts all objects after a step in which the robot moved by `motion` (in its previous
    /// frame) and turned.
    pub(crate) fn predict(&mut self, motion: Point, turned_rad: f64, elapsed_s: f64) {
        let back = direction(-turned_rad);
        for object in &mut self.objects {
            object.at = turned(motion.to(object.at), back);
            object.age_s += elapsed_s;
        }
        self.objects.retain(|object| object.age_s <= MAX_AGE_S);
    }

    /// Updates the objects with a scan; hits for which `is_known` holds are skipped.
    pub(crate) fn update(
        &mut self,
        ring: &Ring,
        ranges_m: &[f64],
        is_known: impl Fn(Point) -> bool,
    ) {
        let mut segmenter = Segmenter::default();
        for ray in ring.rays(ranges_m) {
            self.add_segment(segmenter.next(ray), &is_known);
        }
        if !ring.is_round() {
            return;
        }
        // A segment that begins before the first ray continues after it.
        for ray in ring.rays(ranges_m) {
            if segmenter.nearest.is_none() {
                return;
            }
            self.add_segment(segmenter.next(ray), &is_known);
        }
    }

    fn add_segment(&mut self, segment: Option<(Ray, f64)>, is_known: impl Fn(Point) -> bool) {
        if let Some((nearest, width_m)) = segment
            && width_m <= MAX_WIDTH_M
            && !is_known(nearest.end())
        {
            self.associate(&nearest, width_m / 2.0);
        }
    }

    /// Updates the object whose nearest point is the end of a ray, or adds a new one.
    fn associate(&mut self, ray: &Ray, radius_m: f64) {
        let at = ray.end();
        let is_same =
            |object: &ScanObject| object.age_s > 0.0 && object.at.to(at).length() <= ASSOCIATION_M;
        let known = self.objects.iter().position(is_same);
        if let Some(object) = known.map(|index| &mut self.objects[index]) {
            let rate_m_s = (object.at.length() - ray.range_m) / object.age_s;
            let rate_m_s = rate_m_s.clamp(-MAX_CLOSING_M_S, MAX_CLOSING_M_S);
            object.closing_m_s += GAIN * (rate_m_s - object.closing_m_s);
            object.observations = object.observations.saturating_add(1);
            (object.at, object.radius_m, object.age_s) = (at, radius_m, 0.0);
        } else if self.objects.len() < MAX_OBJECTS {
            self.objects.push(ScanObject {
                at,
                radius_m,
                closing_m_s: 0.0,
                observations: 1,
                age_s: 0.0,
            });
        }
    }

    /// The objects that count as moving.
    pub(crate) fn moving(&self) -> impl Iterator<Item = Mover> {
        let is_moving = |object: &&ScanObject| {
            object.observations >= MIN_OBSERVATIONS && object.closing_m_s.abs() >= MIN_CLOSING_M_S
        };
        self.objects.iter().filter(is_moving).map(|object| {
            let distance_m = object.at.length().max(f64::MIN_POSITIVE);
            let towards = object.at.times(-1.0 / distance_m);
            Mover {
                id: None,
                at: object.at,
                velocity_m_s: towards.times(object.closing_m_s),
                course: towards.times(object.closing_m_s.signum()),
                radius_m: object.radius_m,
                braking_m_s2: f64::INFINITY,
                age_s: object.age_s,
                observations: object.observations,
                ..Mover::default()
            }
        })
    }
}

/// Finds the foreground segments of a scan, ray by ray.
#[derive(Debug, Default)]
struct Segmenter {
    before: Option<Ray>,
    /// The first and the nearest ray of the current segment.
    first: Option<Ray>,
    nearest: Option<Ray>,
}

impl Segmenter {
    /// Adds a ray; returns the nearest ray and the width of a segment that ends before it.
    fn next(&mut self, ray: Ray) -> Option<(Ray, f64)> {
        let before = self.before.replace(ray)?;
        let jump_m = ray.range_m - before.range_m;
        if jump_m < -SAME_OBJECT_M {
            (self.first, self.nearest) = (Some(ray), Some(ray));
        } else if jump_m > SAME_OBJECT_M {
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
