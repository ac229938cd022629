//! The heir's half of owner leases: it keeps the descriptions of goals, grants and renews the leases of
//! their owners, and owns the goals of lost owners until it can return them.

use super::Controller;
use super::heirs::{MAX_LEASE_S, RETRY_S};
use super::owned::{Heir, Owned, note_assignee};
use super::wards::Ward;
use brain::{AgentId, Assignment, Award, Claim, Dispatch, GoalId, Percept, Renewal, Task, wait_s};

impl Controller {
    /// Takes the description of a goal of which it is to be the heir.
    pub(super) fn take_entrusted(&mut self, from: AgentId, task: Task, percept: &Percept) {
        self.hand_over(from, task.id);
        let is_own = self
            .goals
            .iter()
            .any(|owned| owned.task.id == task.id && !owned.is_done);
        let is_full = self.wards.len() >= self.settings.max_goals as usize;
        let known = self.wards.iter().find(|ward| ward.task.id == task.id);
        let number = match known {
            _ if is_own || !task.is_valid() || !self.may_grant() => return,
            Some(ward) if ward.owner == from => ward.number,
            Some(ward) if ward.is_bound => return,
            None if is_full => return,
            _ => {
                self.wards.retain(|ward| ward.task.id != task.id);
                let number = self.numbers.next(percept);
                let due_at_s = self.now_s + f64::from(task.due_s);
                self.wards.push(Ward::new(task, due_at_s, from, number));
                number
            }
        };
        self.confirm(from, task.id, number);
    }

    /// A goal that it has inherited belongs to its previous owner again, to which a person has issued it
    /// meanwhile: two controllers own it. It gives it up if no robot serves it for it.
    fn hand_over(&mut self, origin: AgentId, goal: GoalId) {
        if self.services.grant_of(goal).is_none() {
            self.goals.retain(|owned| {
                let is_free = owned.heir == Heir::None && !owned.is_done;
                !(owned.task.id == goal && owned.origin == Some(origin) && is_free)
            });
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn confirm(&mut self, owner: AgentId, goal: GoalId, number: u32) {
        let lease_s = self.settings.owner_lease_s as f32;
        self.send(
            owner,
            Dispatch::Entrusted(Award {
                goal,
                number,
                lease_s,
            }),
        );
    }

    /// An owner is bound: its lease begins. A binding that names another answer has no effect.
    pub(super) fn take_binding(&mut self, from: AgentId, binding: Award) {
        let Award {
            goal,
            number,
            lease_s,
        } = binding;
        if !(0.0..=MAX_LEASE_S).contains(&lease_s) {
            return;
        }
        self.release_to_origin(from, goal, number);
        let service_wait_s = wait_s(lease_s.into(), self.settings.max_drift);
        let (now_s, owner_wait_s, claim) =
            (self.now_s, self.owner_wait_s(), Claim { goal, number });
        let mut wards = self.wards.iter_mut();
        let Some(ward) = wards.find(|ward| ward.task.id == goal && ward.owner == from) else {
            return;
        };
        if ward.number != number {
            let number = ward.number;
            self.confirm(from, goal, number);
            return;
        }
        let is_granted = self.estates.grant(from, claim, owner_wait_s, now_s)
            || self.estates.renew_one(from, claim, now_s);
        if is_granted {
            (ward.is_bound, ward.service_wait_s) = (true, service_wait_s);
            self.confirm(from, goal, number);
        }
    }

    /// Notes a robot to which the owner of a goal has awarded it: it may report that the goal is done
    /// after this controller has inherited it. The message may arrive after the inheritance.
    pub(super) fn take_assignment(&mut self, from: AgentId, assignment: Assignment) {
        let Assignment { goal, robot } = assignment;
        if !robot.is_robot() {
            return;
        }
        let mut wards = self.wards.iter_mut();
        if let Some(ward) = wards.find(|ward| ward.task.id == goal && ward.owner == from) {
            note_assignee(&mut ward.assignees, robot);
        }
        let inherited = self.goal_mut(goal);
        if let Some(owned) = inherited.filter(|owned| owned.origin == Some(from)) {
            note_assignee(&mut owned.assignees, robot);
        }
    }

    /// Offers an inherited goal to the controller that owned it, while no robot serves it.
    pub(super) fn offer_return(&mut self, index: usize) -> bool {
        let now_s = self.now_s;
        let is_free = self.services.grant_of(self.goals[index].task.id).is_none();
        let owned = &mut self.goals[index];
        let task = owned.task_at(now_s);
        let Some(origin) = owned
            .origin
            .filter(|_| is_free && now_s >= owned.next_return_s)
        else {
            return false;
        };
        owned.next_return_s = now_s + RETRY_S;
        self.send(origin, Dispatch::Restore(task));
        true
    }

    /// An inherited goal that no robot serves becomes a ward of its previous owner, which answered
    /// that it owns the goal again.
    fn release_to_origin(&mut self, origin: AgentId, goal: GoalId, number: u32) {
        let is_free = self.services.grant_of(goal).is_none();
        let mut goals = self.goals.iter();
        let index = goals.position(|owned| {
            let is_returned = owned.task.id == goal && owned.origin == Some(origin);
            is_returned
                && owned.heir == Heir::None
                && !owned.is_done
                && owned.next_return_s.is_finite()
        });
        let Some(index) = index.filter(|_| is_free) else {
            return;
        };
        let owned = self.goals.remove(index);
        self.bids.remove_for(goal);
        let mut ward = Ward::new(owned.task, owned.due_at_s, origin, number);
        ward.assignees = owned.assignees;
        self.wards.push(ward);
    }

    /// Renews the leases by which the sender owns its goals.
    pub(super) fn renew_estates(&mut self, from: AgentId, renewal: Renewal) {
        let answer = if self.estates.renew(from, renewal, self.now_s) {
            Dispatch::Renewed(renewal.number)
        } else {
            Dispatch::Differs(renewal.number)
        };
        self.send(from, answer);
    }

    /// Renews one lease. A controller that is not the heir answers that.
    pub(super) fn renew_estate(&mut self, from: AgentId, claim: Claim) {
        if self.estates.renew_one(from, claim, self.now_s) {
            self.send(from, Dispatch::RenewedOne(claim));
        } else {
            self.take_relief(from, claim);
        }
    }

    /// It is the heir no longer, unless it owns the goal by now.
    pub(super) fn take_relief(&mut self, from: AgentId, claim: Claim) {
        if self
            .goals
            .iter()
            .any(|owned| owned.task.id == claim.goal && !owned.is_done)
        {
            return;
        }
        let is_it = |ward: &Ward| ward.task.id == claim.goal && ward.owner == from;
        if self
            .wards
            .iter()
            .any(|ward| ward.task.id == claim.goal && ward.owner != from)
        {
            return;
        }
        self.wards.retain(|ward| !is_it(ward));
        self.estates.end(claim.goal);
        self.send(from, Dispatch::Relieved(claim));
    }

    /// Owns the goals whose owners have been lost.
    pub(super) fn inherit(&mut self) {
        for grant in self.estates.expire(self.now_s) {
            let mut wards = self.wards.iter();
            let Some(index) = wards.position(|ward| ward.task.id == grant.goal && ward.is_bound)
            else {
                continue;
            };
            let ward = self.wards.remove(index);
            let mut owned = Owned::new(ward.task, self.now_s, ward.service_wait_s);
            owned.due_at_s = ward.due_at_s;
            (owned.origin, owned.assignees) = (Some(ward.owner), ward.assignees);
            self.goals.retain(|owned| owned.task.id != grant.goal);
            self.goals.push(owned);
        }
    }
}
