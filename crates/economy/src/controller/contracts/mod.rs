//! Contracts: goals are offered to robots, awarded to one of them under a service lease, and end as served or returned.
//!
//! * [`calls`]: goals are offered; [`auction`]: awards, in each [`round`], by what robots [bid](bids);
//! * [`receive`]: the effect of each message of a robot;
//! * [`arbitration`]: whether a robot keeps a goal; [`displacement`]: valuable goals before others;
//! * [`unserved`]: goals that no robot can serve.

mod arbitration;
mod auction;
mod bids;
mod calls;
mod displacement;
mod receive;
mod round;
mod unserved;

pub(crate) use calls::{CALLS_PER_STEP, REPEAT_S};
pub(crate) use receive::is_plausible;

use super::context::Context;
use base::hashed::Hashed;
use bids::Bids;
use brain::{AgentId, GoalId, Grant, Grantor};
use calls::call;
use round::Round;
use unserved::probe;

#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct Contracts {
    /// The service leases that it has granted.
    services: Grantor,
    bids: Bids,
    round: Round,
    /// Number of awards, and of leases that ended because the robot was silent.
    pub(super) awards: u32,
    pub(super) lapses: u32,
}

impl Contracts {
    /// Offers goals, awards them, and moves or gives up those that are not served.
    pub(super) fn step(&mut self, context: &mut Context) {
        call(context);
        self.award(context);
        self.arbitrate(context);
        self.call_full_robots(context);
        probe(context);
    }

    /// Ends what has ended by the clock.
    pub(super) fn expire(&mut self, context: &mut Context) {
        for Grant { goal, holder, .. } in self.services.expire(context.now_s) {
            self.lost_assignee(context, goal, holder);
        }
        self.bids.expire(context.now_s);
    }

    /// Whether no robot holds the lease of a goal.
    pub(super) fn is_free(&self, goal: GoalId) -> bool {
        self.services.grant_of(goal).is_none()
    }

    /// The robot that holds the lease of a goal, and how long at most it still does.
    pub(super) fn assignee(&self, goal: GoalId, now_s: f64) -> Option<(AgentId, f64)> {
        let grant = self.services.grant_of(goal)?;
        Some((grant.holder, (grant.until_s - now_s).max(0.0)))
    }

    /// Forgets a goal that the controller owns no longer: its lease is renewed no more.
    pub(super) fn forget(&mut self, goal: GoalId) {
        self.services.withdraw(goal);
        self.forget_bids(goal);
    }

    /// Bids for a goal count no more.
    pub(super) fn forget_bids(&mut self, goal: GoalId) {
        self.bids.remove_for(goal);
    }
}
