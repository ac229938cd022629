//! Flocking.

use super::common::ahead;
use crate::behaviours::behaviour::Behaviour;
use crate::goals::proposal::Proposal;
use crate::io::body::Body;
use crate::io::command::Motion;
use crate::io::percept::Neighbour;
use crate::io::random_words::RandomWords;
use crate::perception::sector::direction;
use crate::situation::Situation;
use base::geometry::Point;
use base::trig::wrapped;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Maximum age of an observed neighbour, in seconds.
const OLDEST_S: f64 = 1.0;

/// Larger ranges and angles are invalid.
const MAX_RANGE_M: f64 = 1e6;
const MAX_ANGLE_RAD: f64 = 1e4;

/// Moves in a flock with the robots that its sensors detect: separation from those too near,
/// alignment with their headings, and cohesion, the attraction to their centre. The three requests are added to the robot's own unit heading,
/// separation first, until they reach the steering limit (C. Reynolds, *Flocks, herds, and schools:
/// a distributed behavioral model*, 1987). The robot turns to the resulting heading, plus noise.
///
/// Alignment needs a sensor that measures headings. A robot that is detected twice counts twice.
///
/// With `averages = false`, `alignment = 1`, a `steering_limit` that is never reached and the other
/// weights 0, each robot takes the mean heading of all in range, itself included (T. Vicsek et al.,
/// *Novel type of phase transition in a system of self-driven particles*, 1995).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(inline)]
pub struct Flock {
    /// Robots nearer than this, from centre to centre, are too near, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub separation_m: f64,
    /// Weight of the vector away from robots that are too near, per metre.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub separation: f64,
    /// Weight of the unit headings of the others.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub alignment: f64,
    /// Weight of the vector towards the others, per metre.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub cohesion: f64,
    /// Whether each of these is the mean over all others in range. Otherwise it is their sum, so
    /// that each of them counts as much as the robot itself.
    pub averages: bool,
    /// Maximum length of the sum of the three.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub steering_limit: f64,
    /// Width of the interval about the resulting heading from which each step draws one, in
    /// degrees.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub noise_deg: f64,
    /// Speed, in m/s. Without it, the maximum speed of the body.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub speed_m_s: Option<f64>,
}

impl Default for Flock {
    fn default() -> Self {
        Self {
            separation_m: 1.0,
            separation: 1.0,
            alignment: 0.1,
            cohesion: 0.03,
            averages: true,
            steering_limit: 1.0,
            noise_deg: 0.0,
            speed_m_s: None,
        }
    }
}

/// Sums over the others in range, in any common frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sums {
    /// Number of others.
    pub count: f64,
    /// Sum of the vectors to them, in metres.
    pub way: Point,
    /// Sum of their unit headings.
    pub course: Point,
    /// Sum of the vectors to those that are too near, in metres.
    pub way_to_near: Point,
}

/// [`Flock`] in a body.
#[derive(Debug, Clone)]
pub struct Ready {
    separation_m: f64,
    separation: f64,
    alignment: f64,
    cohesion: f64,
    averages: bool,
    steering_limit: f64,
    noise_rad: f64,
    speed_m_s: f64,
    period_s: f64,
    max_turn_rad_s: f64,
}

impl Ready {
    pub(super) fn new(spec: &Flock, body: &Body) -> Self {
        Self {
            separation_m: spec.separation_m,
            separation: spec.separation,
            alignment: spec.alignment,
            cohesion: spec.cohesion,
            averages: spec.averages,
            steering_limit: spec.steering_limit,
            noise_rad: spec.noise_deg.to_radians(),
            speed_m_s: ahead(spec.speed_m_s, body)
                .speed_m_s
                .min(body.max_speed_m_s),
            period_s: body.period_s,
            max_turn_rad_s: body.max_turn_rate_rad_s,
        }
    }

    /// Distance below which another robot is too near, in metres.
    #[must_use]
    pub fn separation_m(&self) -> f64 {
        self.separation_m
    }

    /// Its constant speed, in m/s.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.speed_m_s
    }

    /// Turn rate in rad/s of a robot with the unit heading `front`, given its neighbours.
    /// `random_words` is called only if noise is configured.
    #[inline]
    pub fn turn_rate_rad_s(
        &self,
        front: Point,
        sums: &Sums,
        random_words: impl FnOnce() -> RandomWords,
    ) -> f64 {
        let course = front.plus(self.steering(sums));
        let turn_rad = libm::atan2(front.cross(course), front.dot(course));
        let turn_rad = if self.noise_rad > 0.0 {
            wrapped(turn_rad + self.noise_rad * random_words().between(-0.5, 0.5))
        } else {
            turn_rad
        };
        let most = self.max_turn_rad_s;
        (turn_rad / self.period_s).max(-most).min(most)
    }

    /// The sum of the three requests, up to the steering limit.
    #[inline]
    fn steering(&self, sums: &Sums) -> Point {
        let share = if self.averages {
            1.0 / sums.count.max(1.0)
        } else {
            1.0
        };
        let proposals = [
            sums.way_to_near.times(-self.separation * share),
            sums.course.times(self.alignment * share),
            sums.way.times(self.cohesion * share),
        ];
        let (mut steering, mut left) = (Point::default(), self.steering_limit);
        for proposal in proposals {
            let length = proposal.length();
            let granted = if length <= left { 1.0 } else { left / length };
            steering = steering.plus(proposal.times(granted));
            left = (left - length).max(0.0);
        }
        steering
    }

    /// Sums over the neighbours of a percept, relative to the robot's front.
    fn sums(&self, neighbours: &[Neighbour]) -> Sums {
        let mut sums = Sums::default();
        for neighbour in neighbours.iter().filter(|each| is_sensible(each)) {
            let way = direction(neighbour.bearing_rad).times(neighbour.range_m);
            sums.count += 1.0;
            sums.way = sums.way.plus(way);
            if neighbour.range_m < self.separation_m {
                sums.way_to_near = sums.way_to_near.plus(way);
            }
            let course_rad = neighbour
                .course_rad
                .filter(|course_rad| is_angle(*course_rad));
            if let Some(course_rad) = course_rad {
                sums.course = sums.course.plus(direction(course_rad));
            }
        }
        sums
    }
}

fn is_sensible(neighbour: &Neighbour) -> bool {
    (0.0..=MAX_RANGE_M).contains(&neighbour.range_m)
        && is_angle(neighbour.bearing_rad)
        && (0.0..=OLDEST_S).contains(&neighbour.age_s)
}

fn is_angle(angle_rad: f64) -> bool {
    angle_rad.abs() <= MAX_ANGLE_RAD
}

impl Behaviour for Ready {
    type Memory = ();

    fn memory(&self) {}

    fn triggered(&self, (): &mut (), situation: &Situation) -> Option<Proposal> {
        let sums = self.sums(&situation.percept.neighbours);
        let front = Point { x: 1.0, y: 0.0 };
        let motion = Motion {
            speed_m_s: self.speed_m_s,
            turn_rate_rad_s: self.turn_rate_rad_s(front, &sums, || situation.random_words()),
        };
        Some(motion.into())
    }

    fn held(&self) -> Motion {
        Motion {
            speed_m_s: self.speed_m_s,
            turn_rate_rad_s: 0.0,
        }
    }
}

#[cfg(test)]
mod tests;
