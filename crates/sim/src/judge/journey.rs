//! The way of a robot to a goal.

use crate::bodies::body_state::BodyState;
use base::hashed::Hashed;
use brain::AgentId;

/// The way of a robot to the goal that it last reported to drive to; all times are steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Hashed)]
pub(crate) struct Journey {
    /// Number of the goal.
    pub(crate) goal: Option<usize>,
    began_at: u64,
    /// Since when it is there.
    arrived_at: Option<u64>,
    /// Steps in which it stood under way.
    blocked: u64,
}

/// The service of a goal, in steps.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Service {
    /// The robot; `None` if it was removed.
    pub(crate) by: Option<AgentId>,
    /// When the robot set out for it, for the last time.
    pub(crate) began_at: u64,
    pub(crate) arrived_at: u64,
    pub(crate) at: u64,
    /// Steps in which the robot stood under way.
    pub(crate) blocked: u64,
}

impl Journey {
    pub(super) fn begin(goal: Option<usize>, now: u64, is_there: bool) -> Self {
        Self {
            goal,
            began_at: now,
            arrived_at: is_there.then_some(now),
            blocked: 0,
        }
    }

    /// Notes where the robot is in a later step.
    pub(super) fn go_on(&mut self, now: u64, body_state: &BodyState, is_there: bool) {
        let stands = body_state.speed_m_s == 0.0 && body_state.turn_rate_rad_s == 0.0;
        if !is_there {
            self.arrived_at = None;
            self.blocked += u64::from(stands);
        } else if self.arrived_at.is_none() {
            self.arrived_at = Some(now);
        }
    }

    /// The journey, if it leads to this goal; otherwise one that begins and ends when the robot came there: it
    /// may be there already when the goal is awarded, and announces nothing.
    pub(super) fn to(&self, goal: usize, since: u64) -> Self {
        if self.goal == Some(goal) {
            *self
        } else {
            Self::begin(Some(goal), since, true)
        }
    }

    /// The same journey to a goal that has another number now.
    pub(crate) fn with_goal(self, goal: usize) -> Self {
        Self {
            goal: Some(goal),
            ..self
        }
    }

    /// The service that ends it, of a goal that was issued at a time.
    pub(super) fn service(&self, by: AgentId, issued_at: u64, now: u64) -> Service {
        let began_at = self.began_at.max(issued_at);
        let arrived_at = self.arrived_at.unwrap_or(now).max(began_at);
        Service {
            by: Some(by),
            began_at,
            arrived_at,
            at: now,
            blocked: self.blocked.min(arrived_at - began_at),
        }
    }
}
