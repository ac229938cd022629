//! Owner leases: each goal has at most one owner, and its heir gets it when the owner is lost.
//!
//! The controller with the highest serial number in range (Miller 1990) holds the goal's description
//! and alone grants and renews the owner's lease:
//!
//! ```text
//! owner                      heir
//!       -- Entrust -->              it keeps the description
//!       <-- Entrusted --            with a number, and the duration of its leases
//!       -- Bind (number) -->        the owner's lease counts from sending this,
//!       <-- Entrusted --            the heir's wait from receiving it
//!       -- Renew -->
//!       <-- Renewed --              and so on
//! ```
//!
//! Before it sends `Bind`, the owner needs no lease: no heir waits for its end. From then on, only the
//! heir's `Relieved` ends that. If the lease ends, the heir owns the goal, and awards it when the
//! longest service lease of the previous owner has ended, too; if the heir is lost as well, the goal is
//! orphaned. An heir that owns the goal of a controller that is in range again returns it: it sends
//! `Restore`, and the answer is `Bind`.

use super::owned::Heir;
use super::{Controller, short};
use brain::{AgentId, Assignment, Award, Claim, Dispatch, GoalId, Percept};

/// A message without an answer is repeated after this time, in seconds.
pub(super) const RETRY_S: f64 = 2.0;

/// The same for one that binds to an heir.
const BINDING_RETRY_S: f64 = 0.5;

/// Maximum number of such messages per step.
const MAX_MESSAGES: usize = 4;

/// Longer leases are invalid, in seconds.
pub(super) const MAX_LEASE_S: f32 = 3600.0;

impl Controller {
    /// Names heirs, renews leases, and returns goals.
    pub(super) fn settle_heirs(&mut self, percept: &Percept) {
        let mut left = MAX_MESSAGES;
        for index in 0..self.goals.len() {
            if left == 0 {
                break;
            }
            if self.settle_heir(index, percept) {
                left -= 1;
            }
        }
        self.renew_tenures(percept);
    }

    /// Sends the next message about the heir of a goal; returns whether there was one to send.
    fn settle_heir(&mut self, index: usize, percept: &Percept) -> bool {
        let owned = &self.goals[index];
        let (goal, task, now_s) = (owned.task.id, owned.task_at(self.now_s), self.now_s);
        let best = self.colleagues.highest();
        let returns_to = owned
            .origin
            .filter(|origin| self.colleagues.is_near(*origin));
        match owned.heir {
            Heir::None if owned.is_done => false,
            Heir::None if returns_to.is_some() => self.offer_return(index),
            Heir::None => {
                let Some(heir) = best else {
                    return false;
                };
                self.goals[index].heir = Heir::Offered {
                    heir,
                    next_s: now_s,
                };
                self.settle_heir(index, percept)
            }
            Heir::Offered { heir, next_s } => {
                if owned.is_done || best != Some(heir) {
                    self.goals[index].heir = Heir::None;
                } else if now_s >= next_s {
                    let next_s = now_s + RETRY_S;
                    self.goals[index].heir = Heir::Offered { heir, next_s };
                    self.send(heir, Dispatch::Entrust(task));
                    return true;
                }
                false
            }
            Heir::Bound {
                heir,
                is_confirmed: false,
                next_s,
                number,
            } if now_s >= next_s => {
                self.bind(goal, heir, number);
                true
            }
            Heir::Bound { heir, .. } => {
                let is_better = best.is_some_and(|best| best > heir);
                if owned.is_done || returns_to.is_some_and(|origin| origin != heir) || is_better {
                    self.goals[index].heir = Heir::Relieving {
                        heir,
                        next_s: now_s,
                    };
                    return self.settle_heir(index, percept);
                }
                false
            }
            Heir::Relieving { heir, next_s } if now_s >= next_s => {
                self.relieve(index, heir, percept);
                true
            }
            Heir::Relieving { .. } => false,
        }
    }

    fn relieve(&mut self, index: usize, heir: AgentId, percept: &Percept) {
        let (goal, now_s) = (self.goals[index].task.id, self.now_s);
        let next_s = now_s + RETRY_S;
        self.goals[index].heir = Heir::Relieving { heir, next_s };
        let number = self.numbers.next(percept);
        self.tenures.request(number, heir, Some(goal), now_s);
        self.send(heir, Dispatch::Relieve(Claim { goal, number }));
    }

    /// From now on, the goal is owned only under a lease. An heir that answered an earlier request before it received the
    /// binding did not know that it would be bound: such an answer relieves it no more.
    pub(super) fn bind(&mut self, goal: GoalId, heir: AgentId, number: u32) {
        self.tenures.forget_requests(goal);
        let (now_s, lease_s) = (self.now_s, self.settings.service_lease_s);
        if let Some(owned) = self.goal_mut(goal) {
            owned.heir = Heir::Bound {
                heir,
                number,
                is_confirmed: false,
                next_s: now_s + BINDING_RETRY_S,
            };
        }
        self.send_binding(goal, heir, number, lease_s);
    }

    #[expect(clippy::cast_possible_truncation, reason = "messages are short")]
    pub(super) fn send_binding(&mut self, goal: GoalId, heir: AgentId, number: u32, lease_s: f64) {
        let lease_s = lease_s as f32;
        self.send(
            heir,
            Dispatch::Bind(Award {
                goal,
                number,
                lease_s,
            }),
        );
    }

    /// Takes the answer of an heir: that it is ready, that it knows that it is bound, or that it
    /// returns the goal.
    pub(super) fn take_answer(&mut self, from: AgentId, answer: Award) {
        let Award {
            goal,
            number,
            lease_s,
        } = answer;
        let min_lease_s = short(self.settings.min_owner_lease_s());
        if !(min_lease_s..=MAX_LEASE_S).contains(&lease_s) {
            return;
        }
        let (now_s, claim) = (self.now_s, Claim { goal, number });
        match self.goal_mut(goal).map(|owned| owned.heir) {
            Some(Heir::Offered { heir, .. }) if heir == from => {
                // The lease counts from the first binding: the heir may receive any of them.
                self.tenures.request(number, heir, Some(goal), now_s);
                self.tenures.accept(from, claim, lease_s.into(), now_s);
                self.bind(goal, heir, number);
            }
            Some(Heir::Bound {
                heir,
                number: bound,
                next_s,
                ..
            }) if heir == from && bound == number => {
                if let Some(owned) = self.goal_mut(goal) {
                    let is_confirmed = true;
                    owned.heir = Heir::Bound {
                        heir,
                        number,
                        is_confirmed,
                        next_s,
                    };
                }
                self.report_assignees(goal);
            }
            // It names another answer than the one to which the binding refers.
            Some(Heir::Bound {
                heir,
                is_confirmed: false,
                ..
            }) if heir == from => self.bind(goal, heir, number),
            None => self.take_back(from, claim, lease_s.into()),
            Some(_) => {}
        }
    }

    /// Reports to the heir which robots can report that a goal is done: when it becomes the heir, at each
    /// award, and again at its commitment, as messages may be lost.
    pub(super) fn report_assignees(&mut self, goal: GoalId) {
        let owned = self.goals.iter().find(|owned| owned.task.id == goal);
        let Some((heir, owned)) = owned.and_then(|owned| Some((owned.heir.bound()?, owned))) else {
            return;
        };
        for robot in owned.assignees.clone() {
            self.send(heir, Dispatch::Assigned(Assignment { goal, robot }));
        }
    }

    /// The heir is relieved: the goal is owned without a lease, if the lease has not ended.
    pub(super) fn take_relieved(&mut self, from: AgentId, claim: Claim) {
        let is_held = self.tenures.is_held(claim.goal, self.now_s);
        if !self.tenures.is_answer(from, claim) || !is_held {
            return;
        }
        self.tenures.release(claim.goal);
        if let Some(owned) = self.goal_mut(claim.goal) {
            owned.heir = Heir::None;
        }
    }
}
