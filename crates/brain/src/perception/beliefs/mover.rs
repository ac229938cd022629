//! A robot, or another moving thing.

use crate::io::body::RobotId;
use base::geometry::Point;

/// Nothing goes faster, in m/s: a greater velocity is a slip of the sensors.
const FASTEST_M_S: f64 = 100.0;

/// Who is slower stands, in m/s.
const MOVES_M_S: f64 = 0.1;

/// A robot, or whatever else moves, as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mover {
    /// Which robot, if it is known for one.
    pub(crate) id: Option<RobotId>,
    /// From this robot's front.
    pub(crate) at: Point,
    /// Over ground, along this robot's front and left.
    pub(crate) velocity_m_s: Point,
    /// The direction in which it last went, of length 1; of length 0 if it never moved.
    pub(crate) course: Point,
    /// Of the disc that it covers.
    pub(crate) radius_m: f64,
    /// It brakes at most so hard.
    pub(crate) braking_m_s2: f64,
    /// Time since it was last seen.
    pub(crate) age_s: f64,
    /// Looks at it so far: only two make a velocity.
    pub(crate) observations: u32,
}

impl Mover {
    /// Takes in where it was seen; its velocity is corrected by what the guess was off.
    pub(super) fn correct(&mut self, at: Point, age_s: f64, share: f64) {
        // What was told of before says nothing new.
        let between_s = self.age_s - age_s;
        if between_s <= 0.0 {
            return;
        }
        let velocity = self.velocity_m_s;
        let guess = velocity.times(age_s).to(self.at);
        let change = guess.to(at).times(1.0 / between_s);
        let share = if self.observations == 1 { 1.0 } else { share };
        let corrected = velocity.plus(change.times(share));
        if corrected.length_squared() <= FASTEST_M_S * FASTEST_M_S {
            self.velocity_m_s = corrected;
        }
        let speed_m_s = self.speed_m_s();
        if speed_m_s > MOVES_M_S {
            self.course = self.velocity_m_s.times(1.0 / speed_m_s);
        }
        self.at = at.plus(self.velocity_m_s.times(age_s));
        self.age_s = age_s;
        self.observations = self.observations.saturating_add(1);
    }

    /// So far it still goes if it brakes now.
    pub(super) fn stopping_m(&self) -> f64 {
        self.velocity_m_s.length_squared() / (2.0 * self.braking_m_s2)
    }

    /// How fast it goes.
    #[must_use]
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.velocity_m_s.length()
    }
}
