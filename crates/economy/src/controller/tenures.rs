//! The owner's half of owner leases: renewals, their end, and goals that an heir returns.

use super::Controller;
use super::owned::{Heir, Owned};
use super::wards::{Orphan, Request};
use alloc::vec::Vec;
use brain::{AgentId, Claim, Dispatch, GoalId, Lease, Percept, Reason, Task};

/// Leases are renewed when this part of their duration is left.
const RENEWED_AT: f64 = 2.0 / 3.0;

/// A renewal of an owner lease without an answer is repeated after this time, in seconds.
pub const RENEWAL_RETRY_S: f64 = 0.5;

/// Maximum number of leases that are renewed one by one in a step.
const MAX_RENEWALS: usize = 16;

impl Controller {
    /// Renews the leases of each heir.
    pub(super) fn renew_tenures(&mut self, percept: &Percept) {
        let is_due = |lease: &&Lease| lease.until_s - self.now_s < RENEWED_AT * lease.lasts_s;
        let heirs = self.tenures.leases().iter().filter(is_due);
        let mut heirs: Vec<AgentId> = heirs.map(|lease| lease.grantor).collect();
        heirs.sort_unstable();
        heirs.dedup();
        if self.now_s < self.next_renewal_s || heirs.is_empty() {
            return;
        }
        self.next_renewal_s = self.now_s + RENEWAL_RETRY_S;
        for heir in heirs {
            let number = self.numbers.next(percept);
            if let Some(renewal) = self.tenures.renewal(heir, number) {
                self.tenures.request(number, heir, None, self.now_s);
                self.send(heir, Dispatch::Renew(renewal));
            }
        }
    }

    /// The lists of leases differ: those that end first are renewed one by one.
    pub(super) fn renew_tenures_one_by_one(
        &mut self,
        from: AgentId,
        number: u32,
        percept: &Percept,
    ) {
        if !self.tenures.differs(from, number) {
            return;
        }
        let own = self
            .tenures
            .leases()
            .iter()
            .filter(|lease| lease.grantor == from);
        let mut own: Vec<Lease> = own.copied().collect();
        own.sort_by(|one, other| one.until_s.total_cmp(&other.until_s));
        for lease in own.into_iter().take(MAX_RENEWALS) {
            let (goal, number) = (lease.goal, self.numbers.next(percept));
            self.tenures.request(number, from, Some(goal), self.now_s);
            self.send(from, Dispatch::RenewOne(Claim { goal, number }));
        }
    }

    /// The goals whose owner lease has ended are orphaned, as far as this controller knows.
    pub(super) fn expire_tenures(&mut self) {
        for goal in self.tenures.expire(self.now_s) {
            let mut goals = self.goals.iter();
            let Some(index) = goals.position(|owned| owned.task.id == goal) else {
                continue;
            };
            self.goals[index].heir = Heir::None;
            if !self.goals[index].is_done {
                let mut owned = self.goals.remove(index);
                owned.assigned = None;
                let request = None;
                self.orphans.push(Orphan { owned, request });
                self.report(goal, 0, Reason::Orphaned);
                self.services.withdraw(goal);
                self.bids.remove_for(goal);
            }
        }
    }

    /// An orphaned goal that has been served is orphaned no longer.
    pub(super) fn restore_orphan(&mut self, from: AgentId, goal: GoalId) {
        let mut orphans = self.orphans.iter();
        let index = orphans.position(|orphan| {
            orphan.owned.task.id == goal && orphan.owned.assignees.contains(&from)
        });
        if let Some(index) = index {
            let mut owned = self.orphans.remove(index).owned;
            owned.is_done = true;
            self.goals.push(owned);
        }
    }

    /// An heir returns a goal: the answer is the request of the lease. A repeated offer has the same answer
    /// for a time, because the messages of both may take longer than the heir waits.
    pub(super) fn take_return(&mut self, from: AgentId, task: Task, percept: &Percept) {
        self.rejoin(from, task.id);
        let is_own = self.goals.iter().any(|owned| owned.task.id == task.id);
        let is_full = self.orphans.len() >= self.settings.max_goals as usize;
        if is_own || is_full || !task.is_valid() || !self.may_grant() {
            return;
        }
        let (goal, now_s) = (task.id, self.now_s);
        let mut orphans = self.orphans.iter();
        let orphan = orphans.find(|orphan| orphan.owned.task.id == goal);
        let sent = orphan.and_then(|orphan| orphan.request).filter(|sent| {
            sent.heir == from && now_s < sent.sent_s + self.settings.owner_lease_s / 2.0
        });
        let request = sent.unwrap_or_else(|| {
            let number = self.numbers.next(percept);
            self.tenures.request(number, from, Some(goal), now_s);
            Request {
                number,
                heir: from,
                sent_s: now_s,
            }
        });
        let mut orphans = self.orphans.iter_mut();
        match orphans.find(|orphan| orphan.owned.task.id == goal) {
            Some(orphan) => orphan.request = Some(request),
            None => self.orphans.push(Orphan {
                owned: Owned::new(task, now_s, 0.0),
                request: Some(request),
            }),
        }
        self.send_binding(goal, from, request.number, self.settings.service_lease_s);
    }

    /// An heir returns a goal that a person has issued here again meanwhile: it is to be the heir of that.
    fn rejoin(&mut self, heir: AgentId, goal: GoalId) {
        let next_s = self.now_s;
        let owned = self.goal_mut(goal).filter(|owned| !owned.is_done);
        if let Some(owned) = owned.filter(|owned| owned.heir == Heir::None) {
            owned.heir = Heir::Offered { heir, next_s };
        }
    }

    /// An heir has granted the ownership of a goal that it returns.
    pub(super) fn take_back(&mut self, heir: AgentId, claim: Claim, lease_s: f64) {
        let Claim { goal, number } = claim;
        let mut orphans = self.orphans.iter();
        let orphan = orphans.position(|orphan| {
            let is_answer = |it: Request| it.number == number && it.heir == heir;
            orphan.owned.task.id == goal && orphan.request.is_some_and(is_answer)
        });
        let Some(index) = orphan else {
            return;
        };
        if self.tenures.accept(heir, claim, lease_s, self.now_s) {
            let Orphan { mut owned, .. } = self.orphans.remove(index);
            owned.offer_again(self.now_s);
            owned.heir = Heir::Bound {
                heir,
                number,
                is_confirmed: true,
                next_s: self.now_s,
            };
            self.goals.push(owned);
        }
    }
}
