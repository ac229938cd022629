//! A tracked robot or other moving object.

use crate::io::agent_id::AgentId;
use base::geometry::Point;
use base::hashed::Hashed;

/// Corrections to higher speeds are ignored as sensor errors.
const MAX_SPEED_M_S: f64 = 100.0;

/// Below this speed an object counts as stationary.
const MIN_SPEED_M_S: f64 = 0.1;

/// A robot is parked when it has stayed for this time, in seconds, within this distance of one
/// place, in metres. Robots that give way to each other do not stand for that long.
const PARKED_S: f64 = 20.0;
const SAME_PLACE_M: f64 = 0.5;

/// The place follows the observations with this time constant, in seconds, and an observation within this
/// number of standard deviations does not leave it.
const PLACE_S: f64 = 10.0;
const SAME_PLACE_DEVIATIONS: f64 = 3.0;

/// The estimated state of a robot or other moving object.
#[derive(Debug, Clone, Copy, Default, PartialEq, Hashed)]
pub(crate) struct Mover {
    /// The robot, if it was identified as one.
    pub(crate) id: Option<AgentId>,
    /// Position in this robot's frame.
    pub(crate) at: Point,
    /// Velocity over ground, in this robot's frame.
    pub(crate) velocity_m_s: Point,
    /// Unit vector of its last direction of motion; zero if it never moved.
    pub(crate) course: Point,
    /// Radius of its footprint.
    pub(crate) radius_m: f64,
    /// Maximum deceleration.
    pub(crate) braking_m_s2: f64,
    /// Time since its last observation.
    pub(crate) age_s: f64,
    /// Number of observations; a velocity needs two.
    pub(crate) observations: u32,
    /// The place where it stands, in this robot's frame, and for how long it has been there.
    pub(crate) place: Point,
    pub(crate) standing_s: f64,
}

impl Mover {
    /// Corrects the state with an observed position; `gain` is that of the velocity, and `noise_m` the
    /// standard deviation of the position along each axis.
    pub(super) fn correct(&mut self, (at, noise_m): (Point, f64), age_s: f64, gain: f64) {
        // A repeated observation is ignored.
        let interval_s = self.age_s - age_s;
        if interval_s <= 0.0 {
            return;
        }
        let velocity = self.velocity_m_s;
        let predicted = velocity.times(age_s).to(self.at);
        let change = predicted.to(at).times(1.0 / interval_s);
        let gain = if self.observations == 1 { 1.0 } else { gain };
        let corrected = velocity.plus(change.times(gain));
        if corrected.length_squared() <= MAX_SPEED_M_S * MAX_SPEED_M_S {
            self.velocity_m_s = corrected;
        }
        self.stand(at, noise_m, interval_s);
        let speed_m_s = self.speed_m_s();
        if speed_m_s > MIN_SPEED_M_S {
            self.course = self.velocity_m_s.times(1.0 / speed_m_s);
        }
        self.at = at.plus(self.velocity_m_s.times(age_s));
        self.age_s = age_s;
        self.observations = self.observations.saturating_add(1);
    }

    /// Takes an observed position into account for how long it has been in one place. The place is a mean: in
    /// this robot's frame, it drifts with the errors of the odometry.
    fn stand(&mut self, at: Point, noise_m: f64, interval_s: f64) {
        if Self::is_same_place(self.place, at, noise_m) {
            let gain = interval_s / (PLACE_S + interval_s);
            self.place = self.place.plus(self.place.to(at).times(gain));
        } else {
            (self.place, self.standing_s) = (at, 0.0);
        }
    }

    /// Whether an observation with a standard deviation of `noise_m` along each axis is of a place.
    pub(super) fn is_same_place(place: Point, at: Point, noise_m: f64) -> bool {
        let same_m = SAME_PLACE_M + SAME_PLACE_DEVIATIONS * noise_m;
        place.to(at).length_squared() <= same_m * same_m
    }

    /// Whether it is an obstacle that paths lead around, rather than one that will move on.
    pub(super) fn is_parked(&self) -> bool {
        self.standing_s >= PARKED_S
    }

    /// Stopping distance if it brakes now.
    pub(super) fn stopping_m(&self) -> f64 {
        self.velocity_m_s.length_squared() / (2.0 * self.braking_m_s2)
    }

    #[must_use]
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.velocity_m_s.length()
    }
}
