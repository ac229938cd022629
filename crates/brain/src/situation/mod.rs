//! The situation of one step, as navigation and behaviours read it.

pub(crate) mod timer;

use crate::io::agent_id::AgentId;
use crate::io::body::Body;
use crate::io::goal_id::{GoalId, GoalPlace};
use crate::io::percept::Percept;
use crate::io::random_words::RandomWords;
use crate::messaging::peers::Peers;
use crate::perception::beliefs::{Beliefs, DriveEstimate, Localisation};
use crate::perception::rays::Ring;
use base::geometry::Point;
use core::cell::Cell;

/// Time for which touch is ignored after a turn, in seconds: the body needs it to leave what it
/// touched.
const CLEARING_S: f64 = 0.5;

/// A body may be blocked after this time without an evasion, in seconds.
const BLOCKED_AFTER_S: f64 = 3.0;

/// With less than this certain to be free, in metres, a body stands or hardly moves.
const STOPPED_M: f64 = 0.01;

/// Free distance in some direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClearAhead {
    /// Current distance from the body and its clearance to the nearest place that is not known to
    /// be free, if walls are flat between two rays; negative if none of it is certain.
    pub(crate) free_m: f64,
    /// The same if corners of obstacles may protrude between two rays.
    pub(crate) certain_m: f64,
    /// Age of the oldest scan that contributed.
    pub(crate) age_s: f64,
}

impl ClearAhead {
    /// What is free by both.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            free_m: self.free_m.min(other.free_m),
            certain_m: self.certain_m.min(other.certain_m),
            age_s: self.age_s.max(other.age_s),
        }
    }
}

/// The percept of a step, with everything derived from it that behaviours share.
#[derive(Debug)]
pub(crate) struct Situation<'s> {
    pub(crate) percept: &'s Percept,
    pub(crate) body: &'s Body,
    /// Beliefs from all percepts so far; `None` in a brain without beliefs.
    pub(crate) beliefs: Option<&'s Beliefs>,
    /// Its estimate of its pose; `None` in a brain that has none.
    pub(crate) localisation: Option<&'s Localisation>,
    /// Its team mates; `None` in a brain without beliefs.
    pub(crate) peers: Option<&'s Peers>,
    pub(crate) rings: &'s [Ring],
    /// Number of the last goal that the robot chose itself.
    pub(crate) last_goal: &'s Cell<u32>,
    /// Free distance straight ahead; `None` without a sensor to the front or without a fresh scan.
    pub(crate) ahead: Option<ClearAhead>,
    /// Time since the previous step.
    pub(crate) elapsed_s: f64,
    /// Angle by which the body has turned since the previous step.
    pub(crate) turned_rad: f64,
    /// Upper bound of the current speed; negative in reverse.
    pub(crate) current_speed_m_s: f64,
}

impl Situation<'_> {
    /// A new goal of the robot at a place.
    pub(crate) fn new_goal(&self, at: Point) -> GoalPlace {
        let number = self.last_goal.get().wrapping_add(1);
        self.last_goal.set(number);
        let issuer = self.percept.id.into();
        GoalPlace {
            id: GoalId { issuer, number },
            at,
        }
    }

    /// The goal at a place that a behaviour has chosen: the previous one if it chose the same place.
    pub(crate) fn goal_at(&self, at: Point, previous: Option<GoalPlace>) -> GoalPlace {
        let same = previous.filter(|previous| previous.at == at);
        same.unwrap_or_else(|| self.new_goal(at))
    }

    /// The position of another robot in the world, if it is tracked or has reported it recently.
    pub(crate) fn position_of(&self, id: AgentId) -> Option<Point> {
        let tracked = self.beliefs?.position_of(id);
        let mut mates = self.peers?.mates.iter();
        let reported = || mates.find(|peer| peer.id == id)?.at();
        tracked.or_else(reported)
    }

    /// Time since the previous step, in single precision, as behaviours store times.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    pub(crate) fn step_s(&self) -> f32 {
        self.elapsed_s as f32
    }

    /// Half of the time that this step is expected to take: the last one, but no gap between
    /// percepts.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is enough"
    )]
    pub(crate) fn half_step_s(&self) -> f32 {
        self.elapsed_s.min(self.body.period_s) as f32 / 2.0
    }

    /// How its drive executes commands; `None` while the robot measures its own motion.
    #[inline]
    pub(crate) fn drive(&self) -> Option<&DriveEstimate> {
        self.localisation.and_then(Localisation::drive)
    }

    /// The angle by which the body still turns after the command to stop turning; 0 while the robot
    /// measures its own motion.
    #[inline]
    pub(crate) fn coasting_rad(&self) -> f64 {
        self.drive().map_or(0.0, DriveEstimate::coasting_rad)
    }

    /// The turn rate with which the body will have turned by an angle after some time and the lag of its
    /// drive.
    #[inline]
    pub(crate) fn turn_rate_rad_s(&self, turn_rad: f64, within_s: f64) -> f64 {
        let lag_s = self.drive().map_or(0.0, |drive| drive.lag_s);
        (turn_rad - self.coasting_rad()) / (within_s + lag_s)
    }

    /// Whether a body without a touch sensor does not move although it has been commanded to for a time:
    /// something that its sensors do not see may be in its way.
    #[inline]
    pub(crate) fn is_blocked(&self, driving_s: f64) -> bool {
        let is_blind = self.percept.touch.is_none() && driving_s >= BLOCKED_AFTER_S;
        is_blind && self.localisation.is_some_and(Localisation::is_blocked)
    }

    /// Whether the body still touches something: it may be stopped by a collision and unable to
    /// move.
    #[inline]
    pub(crate) fn is_held(&self) -> bool {
        self.touches(f64::INFINITY)
    }

    /// The uniform random numbers of this step; every call starts with the first.
    pub(crate) fn random_words(&self) -> RandomWords {
        RandomWords::new(self.percept.random_words)
    }

    /// Stopping distance if the body brakes now.
    #[inline]
    pub(crate) fn stopping_m(&self) -> f64 {
        self.current_speed_m_s * self.current_speed_m_s / (2.0 * self.body.max_acceleration_m_s2)
    }

    /// Whether there is an obstacle within `near_m` straight ahead, or [so little](Self::is_stopped) is
    /// certain to be free. Scans from before the last `straight_s`, for which the body has moved
    /// straight, show another direction and are ignored.
    #[inline]
    pub(crate) fn is_obstacle_ahead(&self, near_m: f64, straight_s: f64) -> bool {
        let is_near = |clear: ClearAhead| clear.free_m < near_m && clear.age_s <= straight_s;
        self.ahead.is_some_and(is_near) || self.is_stopped(straight_s)
    }

    /// Whether so little straight ahead is certain to be free, because corners may protrude, that the body does
    /// not move on; scans count as in [`Self::is_obstacle_ahead`].
    #[inline]
    pub(crate) fn is_stopped(&self, straight_s: f64) -> bool {
        let is_stopped = |clear: ClearAhead| clear.certain_m < clear.free_m.min(STOPPED_M);
        let ahead = self.ahead.filter(|clear| clear.age_s <= straight_s);
        ahead.is_some_and(is_stopped)
    }

    /// Whether the body touches something, if its last turn ended `since_s` ago.
    #[inline]
    pub(crate) fn touches(&self, since_s: f64) -> bool {
        self.percept
            .touch
            .is_some_and(|touch| touch.value && touch.age_s <= since_s - CLEARING_S)
    }

    /// The ranges of each fresh scan, with the element of `per_ring` that belongs to its ring.
    #[inline]
    pub(crate) fn scans_with<'a, T>(
        &'a self,
        per_ring: &'a [T],
    ) -> impl Iterator<Item = (&'a [f64], &'a T)> {
        let rings = self.rings.iter().zip(&self.percept.scans).zip(per_ring);
        rings.filter_map(|((ring, scan), of_ring)| {
            let (_, ranges_m) = ring.fresh(Some(scan))?;
            Some((ranges_m, of_ring))
        })
    }

    /// Each fresh scan: its ring and its ranges.
    pub(crate) fn scans(&self) -> impl Iterator<Item = (&Ring, &[f64])> {
        let rings = self.rings.iter().zip(&self.percept.scans);
        rings.filter_map(|(ring, scan)| Some((ring, ring.fresh(Some(scan))?.1)))
    }
}
