//! The outcome of the goals of a run.

use super::goal_moment::is_late;
use super::goal_tally::GoalTally;
use super::journey::Service;
use super::moment::Moment;

/// The outcome of the goals of a run, named like the columns of results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GoalOutcome {
    /// Goals that a robot served in time.
    pub served: u32,
    /// Goals that several robots served.
    pub served_twice: u32,
    /// Goals that no robot served before their deadline.
    pub expired: u32,
    /// Goals in the other states of their lives.
    pub balance: GoalBalance,
    /// Goals that a robot reported as served in error, and that none has served.
    pub done_in_error: u32,
    /// Time from the issue of a goal until its robot sets out for the last time, in the mean over the goals served; 0
    /// if there are none.
    pub waiting_s: f64,
    /// Time from there to the arrival, except for that in which the robot stood, in the mean.
    pub travel_s: f64,
    /// Time in which the robot stood under way, in the mean.
    pub blocked_s: f64,
    /// Time from the arrival until the goal was served, in the mean.
    pub service_s: f64,
    /// Messages that robots and controllers sent.
    pub messages_sent: u64,
    /// Messages beyond the maximum of a step: not sent by the radio of the sender, or dropped by that of a receiver.
    pub messages_dropped: u64,
    /// Goals that controllers refused because they owned their maximum number.
    pub goals_refused: u32,
    /// Leases of robots that ended because they were not renewed.
    pub leases_lapsed: u32,
}

/// Goals that have been issued, by the states of their lives.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GoalBalance {
    /// Goals that were served, or have expired.
    pub ended: u32,
    /// Goals that may still be served.
    pub open: u32,
    /// Goals of which a controller has reported why they cannot be served.
    pub reported: u32,
    /// Goals that no working agent knows.
    pub unknown: u32,
}

impl GoalBalance {
    /// Goals that have been issued.
    #[must_use]
    pub fn issued(self) -> u32 {
        self.ended + self.open + self.reported + self.unknown
    }
}

impl GoalOutcome {
    pub(super) fn of(moment: &Moment, tally: &GoalTally) -> Self {
        let step_s = moment.scenario.step_s;
        let mean_s = |of: fn(u64, &Service) -> u64| mean(tally, of) * step_s;
        Self {
            served: tally.served(),
            served_twice: count(tally.served_twice()),
            expired: expired(moment, tally),
            balance: GoalBalance::default(),
            done_in_error: count(tally.done_in_error()),
            waiting_s: mean_s(|issued_at, service| service.began_at - issued_at),
            travel_s: mean_s(|_, to| to.arrived_at - to.began_at - to.blocked),
            blocked_s: mean_s(|_, service| service.blocked),
            service_s: mean_s(|_, service| service.at - service.arrived_at),
            messages_sent: tally.messages_sent,
            messages_dropped: tally.messages_dropped,
            goals_refused: moment.goals_refused,
            leases_lapsed: moment.leases_lapsed,
        }
    }
}

/// Goals that expired unserved.
fn expired(moment: &Moment, tally: &GoalTally) -> u32 {
    let goals = moment.goals.all.iter().zip(&tally.records);
    let expired = goals.filter(|(goal, record)| {
        let kind = &moment.scenario.goals[usize::from(goal.kind)];
        let is_expired = |issued_at| is_late(kind.deadline_steps, issued_at, moment.tick);
        record.served.is_none() && record.issued_at.is_some_and(is_expired)
    });
    count(expired.count())
}

/// The mean of a number of steps over the goals served.
#[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
fn mean(tally: &GoalTally, of: fn(u64, &Service) -> u64) -> f64 {
    let steps = tally
        .services()
        .map(|(issued_at, served)| of(issued_at, &served));
    let (count, total) = steps.fold((0_u64, 0_u64), |(count, total), steps| {
        (count + 1, total + steps)
    });
    total as f64 / count.max(1) as f64
}

#[expect(clippy::cast_possible_truncation, reason = "goals have 32-bit numbers")]
fn count(goals: usize) -> u32 {
    goals as u32
}
