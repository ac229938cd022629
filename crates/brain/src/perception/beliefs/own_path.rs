//! Where the robot was recently, in its own frame: late detections are relative to that.

use super::displacement::Displacement;
use super::pose::turned;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// Maximum number of places.
const MAX_PLACES: usize = 32;

/// Intervals between places, at least, in the age of the latest detection. The places of more steps are
/// farther apart than a step; one more is older than that age, and another is new.
const INTERVALS: f64 = 30.0;

/// A pose of the robot some time ago, in its current frame.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(super) struct Place {
    age_s: f64,
    at: Point,
    heading_rad: f64,
}

/// Places at ends of recent steps, the oldest first. None are kept before the first late detection.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct OwnPath {
    places: Vec<Place>,
    /// Maximum age of a detection so far.
    depth_s: f64,
}

impl OwnPath {
    /// Adds the displacement of a step.
    pub(super) fn advance(&mut self, moved: &Displacement) {
        if self.depth_s <= 0.0 {
            return;
        }
        let back = direction(-moved.turned_rad);
        for place in &mut self.places {
            place.age_s += moved.elapsed_s;
            place.at = turned(moved.chord.to(place.at), back);
            place.heading_rad -= moved.turned_rad;
        }
        // One place is kept beyond the depth, to interpolate.
        let stale = self
            .places
            .iter()
            .filter(|place| place.age_s > self.depth_s);
        self.places.drain(..stale.count().saturating_sub(1));
        if self.places.capacity() == 0 {
            self.places.reserve_exact(MAX_PLACES);
        }
        let spacing_s = self.depth_s / INTERVALS;
        if self
            .places
            .last()
            .is_none_or(|last| last.age_s >= spacing_s)
        {
            self.places.push(Place::default());
        }
    }

    /// Transforms a position that was detected some time ago from the frame of the robot then.
    pub(super) fn now(&mut self, then: Point, age_s: f64, moved: &Displacement) -> Point {
        self.depth_s = self.depth_s.max(age_s);
        let place = self.before(age_s, moved);
        place.at.plus(turned(then, direction(place.heading_rad)))
    }

    /// The place some time ago; before the path began, the last motion is assumed.
    fn before(&self, age_s: f64, moved: &Displacement) -> Place {
        let newer = self.places.iter().rposition(|place| place.age_s >= age_s);
        let (from, to) = match newer {
            Some(older) => (self.places[older], self.places.get(older + 1).copied()),
            None => (one_step_before(moved), Some(Place::default())),
        };
        let to = to.unwrap_or_default();
        let share = (age_s - to.age_s) / (from.age_s - to.age_s).max(f64::MIN_POSITIVE);
        Place {
            age_s,
            at: to.at.plus(to.at.to(from.at).times(share)),
            heading_rad: to.heading_rad + share * (from.heading_rad - to.heading_rad),
        }
    }
}

/// The place before a step.
fn one_step_before(moved: &Displacement) -> Place {
    Place {
        age_s: moved.elapsed_s,
        at: turned(moved.chord.times(-1.0), direction(-moved.turned_rad)),
        heading_rad: -moved.turned_rad,
    }
}
