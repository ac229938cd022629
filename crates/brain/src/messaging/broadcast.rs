//! Broadcasts: their schedule, their messages, and what the robot sent last.

use super::commitment::Commitment;
use super::phase::phase;
use super::visits::OwnVisits;
use crate::goals::proposal::Destination;
use crate::io::agent_id::{AgentId, Receiver};
use crate::io::goal_id::GoalPlace;
use crate::io::message::{About, CommitmentStatus, Message};
use crate::perception::beliefs::pose::Pose;
use alloc::vec::Vec;
use base::hashed::Hashed;
use base::trig::wrapped;

/// Time between two broadcasts of the robot's own position. Each robot has its own phase within the
/// period, because a radio receives only a limited number of messages at once.
const BROADCAST_PERIOD_S: f64 = 1.0;

/// The destination and the items are repeated with every third broadcast only: a new destination is
/// broadcast at once, and receivers keep destinations for ten seconds and items for good.
const BROADCASTS_PER_REPEAT: u8 = 3;

/// A robot that has turned by this angle broadcasts its pose at once: receivers assume that it
/// observed in the last heading that it sent, and a narrow field of view leaves that heading within
/// this angle.
const MAX_TURN_RAD: f64 = 0.3;

/// What the robot broadcast last, and when.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct BroadcastState {
    /// Time that a step is expected to take.
    period_s: f64,
    goal: Option<Destination>,
    heading_rad: f64,
    observations: u32,
    /// Time since the last broadcast; `None` before the first step.
    age_s: Option<f64>,
    /// Broadcasts since the last repeat.
    count: u8,
    visits: OwnVisits,
}

impl BroadcastState {
    /// Before the first broadcast of a robot whose steps are expected to take this time.
    pub(super) fn new(period_s: f64) -> Self {
        Self {
            period_s,
            ..Self::default()
        }
    }

    /// Whether a broadcast is due after a step of `elapsed_s`. The sum of steps may be off by half
    /// a step; the remainder counts for the next broadcast, so that the mean rate does not depend
    /// on the steps.
    pub(super) fn is_due(&mut self, own: AgentId, elapsed_s: f64) -> bool {
        let initial_s = || BROADCAST_PERIOD_S * phase(own, [BROADCAST_PERIOD_S, self.period_s]);
        let age_s = self.age_s.unwrap_or_else(initial_s) + elapsed_s;
        let half_s = elapsed_s.min(BROADCAST_PERIOD_S) / 2.0;
        let is_due = age_s >= BROADCAST_PERIOD_S - half_s;
        let max_remainder_s = self.age_s.map_or(half_s, |_| BROADCAST_PERIOD_S / 2.0);
        let remainder_s = (age_s - BROADCAST_PERIOD_S).min(max_remainder_s);
        self.age_s = Some(if is_due { remainder_s } else { age_s });
        if is_due {
            self.count = (self.count + 1) % BROADCASTS_PER_REPEAT;
        }
        is_due
    }

    /// Broadcasts the current destination, and the status of the previous one.
    pub(super) fn broadcast_goal(
        &mut self,
        commitment: &Commitment,
        pose: &Pose,
        is_due: bool,
        outbox: &mut Vec<Message>,
    ) {
        let previous = self.goal;
        let goal = commitment.after(previous);
        let ids = [goal, previous].map(|goal| goal.map(|destination| destination.id));
        let places = [goal, previous].map(|goal| goal.map(|destination| destination.at));
        let (is_new, has_moved) = (ids[0] != ids[1], places[0] != places[1]);
        if !is_new && !has_moved && !is_due {
            return;
        }
        let message = |destination: Destination, status| {
            certain(About::Goal {
                id: destination.id,
                at: destination.at,
                status,
            })
        };
        if let Some(ended) = previous.filter(|_| is_new) {
            if commitment.is_done(&ended, pose) {
                self.visits.add(ended.goal());
                outbox.push(message(ended, CommitmentStatus::Done));
            } else if goal.is_none() {
                // A new destination implies that the previous one is released.
                outbox.push(message(ended, CommitmentStatus::Released));
            }
        }
        outbox.extend(goal.map(|destination| message(destination, CommitmentStatus::Active)));
        self.goal = goal;
    }

    /// Broadcasts one of its own visits again: a robot that missed the message would go there too.
    pub(super) fn repeat_visit(&mut self, outbox: &mut Vec<Message>) {
        outbox.extend(self.visits.next().map(|GoalPlace { id, at }| {
            let status = CommitmentStatus::Done;
            certain(About::Goal { id, at, status })
        }));
    }

    /// Broadcasts the pose and the number of observations so far, if that is due or the robot has
    /// turned since.
    pub(super) fn broadcast_pose(
        &mut self,
        pose: &Pose,
        observations: u32,
        is_due: bool,
        outbox: &mut Vec<Message>,
    ) {
        let turned_rad = wrapped(pose.heading_rad - self.heading_rad).abs();
        let has_turned = turned_rad >= MAX_TURN_RAD && observations != self.observations;
        if is_due || has_turned {
            (self.heading_rad, self.observations) = (pose.heading_rad, observations);
            outbox.push(certain(About::Sender {
                at: pose.at,
                heading_rad: pose.heading_rad,
                observations,
            }));
        }
    }

    /// Whether the last broadcast that was due repeats destination and items.
    pub(super) fn is_repeat(&self) -> bool {
        self.count == 0
    }
}

/// A message with full confidence.
fn certain(about: About) -> Message {
    Message {
        to: Receiver::All,
        about,
        confidence: 1.0,
    }
}

#[cfg(test)]
mod tests;
