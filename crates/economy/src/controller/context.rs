//! What the parts of a controller share: its clock, its outbox, and what it knows of goals, robots and peers.

use super::handover::Role;
use super::ledger::Ledger;
use super::ledger::owned::Owned;
use super::peers::Peers;
use super::robots::Robots;
use crate::settings::Settings;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hashed::Hashed;
use brain::{
    About, AgentId, Assignment, Claim, ContractMessage, GoalId, Message, Numbers, OwnershipMessage,
    Percept, Reason, Receiver, Refusal, Task, wait_s,
};

/// The number of no bid: those of agents begin at 1.
const NO_BID: u32 = 0;

#[derive(Debug, Clone, Hashed)]
pub(super) struct Context {
    #[hashed(skip)]
    pub(super) settings: Arc<Settings>,
    /// The longest service lease that awards had under earlier settings.
    longest_wait_s: f64,
    pub(super) own: AgentId,
    /// Its clock, and the time since the last step.
    pub(super) now_s: f64,
    pub(super) step_s: f64,
    /// Until when it grants nothing, once it knows the time: an agent that restarts does not know
    /// what it granted before.
    silent_until_s: Option<f64>,
    pub(super) numbers: Numbers,
    pub(super) ledger: Ledger,
    pub(super) robots: Robots,
    pub(super) peers: Peers,
    #[hashed(skip)]
    pub(super) outbox: Vec<Message>,
}

impl Context {
    /// At the start of a mission: no agent holds a lease of it.
    pub(super) fn new(settings: Arc<Settings>) -> Self {
        Self {
            settings,
            longest_wait_s: 0.0,
            own: AgentId::default(),
            now_s: f64::NEG_INFINITY,
            step_s: 0.0,
            silent_until_s: Some(f64::NEG_INFINITY),
            numbers: Numbers::default(),
            ledger: Ledger::default(),
            robots: Robots::default(),
            peers: Peers::default(),
            outbox: Vec::new(),
        }
    }

    /// It remembers nothing of an earlier life, and grants nothing for the longest lease.
    pub(super) fn restarted(settings: Arc<Settings>) -> Self {
        Self {
            silent_until_s: None,
            ..Self::new(settings)
        }
    }

    /// Takes other settings; returns whether the controllers that vote are the same. Otherwise, a majority has to vote for it as
    /// the owner of each goal again, and others may have owned its goals before.
    pub(super) fn set(&mut self, settings: Arc<Settings>) -> bool {
        self.longest_wait_s = self.takeover_wait_s();
        let now_s = self.now_s;
        let goals = self.ledger.goals.iter_mut();
        for lost in goals.filter(|it| it.role == Role::Owner && !it.is_held(now_s)) {
            lost.held_until_s = f64::NEG_INFINITY;
            lost.role = Role::candidate(now_s);
        }
        let was = core::mem::replace(&mut self.settings, settings);
        let is_same =
            [was.count, was.votes_needed()] == [self.settings.count, self.settings.votes_needed()];
        if self.votes_needed() > 0 {
            self.ledger.goals.iter_mut().for_each(|it| it.giver = None);
        }
        self.count_votes();
        let goals = self.ledger.goals.iter_mut();
        for owned in goals.filter(|owned| !is_same && !owned.is_held(now_s)) {
            owned.role = Role::candidate(now_s);
        }
        is_same
    }

    /// Waits as long as another controller after a takeover.
    pub(super) fn wait_as(&mut self, other: &Self) {
        self.longest_wait_s = self.longest_wait_s.max(other.takeover_wait_s());
    }

    /// Notes until when it owns its goals.
    pub(super) fn count_votes(&mut self) {
        let needed = self.votes_needed();
        self.ledger.count_votes(needed);
    }

    /// The same for one goal.
    pub(super) fn count_votes_for(&mut self, goal: GoalId) {
        let needed = self.votes_needed();
        self.ledger.count_votes_for(goal, needed);
    }

    /// Forgets controllers that a person has removed: their votes do not count any more.
    pub(super) fn forget_peers(&mut self, is_removed: &impl Fn(AgentId) -> bool) {
        self.peers.list.retain(|peer| !is_removed(peer.id));
        self.ledger.voters.retain(|voter| !is_removed(voter.id));
        for owned in &mut self.ledger.goals {
            owned.votes.retain(|vote| !is_removed(vote.voter));
        }
        self.count_votes();
    }

    /// Begins a step; returns whether its percept is not older than the last one.
    pub(super) fn begin(&mut self, percept: &Percept) -> bool {
        let time_s = percept.time_s.filter(|time_s| time_s.is_finite());
        let now_s = time_s.unwrap_or(self.now_s.max(0.0));
        if now_s < self.now_s {
            return false;
        }
        self.step_s = (now_s - self.now_s).min(1.0);
        (self.now_s, self.own) = (now_s, percept.id);
        self.numbers.step(percept);
        let longest_s = self.takeover_wait_s().max(self.owner_wait_s());
        self.silent_until_s.get_or_insert(now_s + longest_s);
        self.robots.expire(now_s);
        self.peers.expire(now_s);
        true
    }

    /// Whether it grants leases: not before the longest lease of an earlier life has ended.
    pub(super) fn may_grant(&self) -> bool {
        self.silent_until_s
            .is_some_and(|until_s| self.now_s >= until_s)
    }

    pub(super) fn send(&mut self, to: impl Into<Receiver>, about: impl Into<About>) {
        self.outbox.push(Message::to(to, about));
    }

    /// The same with a confidence.
    pub(super) fn send_with(
        &mut self,
        to: impl Into<Receiver>,
        about: impl Into<About>,
        confidence: f64,
    ) {
        self.outbox.push(Message {
            confidence,
            ..Message::to(to, about)
        });
    }

    /// Is a candidate for a goal that a person has issued, or that it has planned.
    pub(super) fn own(&mut self, task: Task) -> Result<(), Reason> {
        if self.ledger.get(task.id).is_some() {
            return Ok(());
        }
        if !task.is_valid() {
            return Err(Reason::Invalid);
        }
        if self.is_full() {
            return Err(Reason::Full);
        }
        let owned = Owned::new(task, self.now_s, f64::INFINITY);
        self.ledger.goals.push(owned);
        self.count_votes_for(task.id);
        Ok(())
    }

    /// Whether it owns the maximum number of goals.
    pub(super) fn is_full(&self) -> bool {
        self.ledger.open(self.now_s) >= self.settings.max_goals as usize
    }

    /// A goal is no longer on offer, except to the robot whose bid has a number, if any has.
    pub(super) fn close_offer(&mut self, goal: GoalId, number: Option<u32>) {
        let number = number.unwrap_or(NO_BID);
        let claim = Claim { goal, number };
        self.send(Receiver::All, ContractMessage::Withdraw(claim));
    }

    /// Reports to the operator that no robot can serve a goal, or that it has been lost.
    pub(super) fn report(&mut self, goal: GoalId, number: u32, reason: Reason) {
        let report = Refusal {
            goal,
            number,
            reason,
        };
        self.ledger.reports.put_unserved(report, self.now_s);
    }

    /// Sends the reports that are due.
    pub(super) fn send_reports(&mut self) {
        for report in self.ledger.reports.due(self.now_s) {
            self.send(AgentId::OPERATOR, report);
        }
    }

    /// Reports to the voters for a goal which robots can report that it is done: at each vote, at each award, and again at its
    /// commitment, as messages may be lost.
    pub(super) fn report_assignees(&mut self, goal: GoalId) {
        let assignees = self.ledger.get(goal).map(|owned| owned.assignees.clone());
        let voters: Vec<AgentId> = self
            .ledger
            .votes_for(goal)
            .map(|(voter, _)| voter)
            .collect();
        for robot in assignees.into_iter().flatten() {
            for voter in &voters {
                let assignment = Assignment { goal, robot };
                self.send(*voter, OwnershipMessage::Assigned(assignment));
            }
        }
    }

    /// Whether another controller is of its kind.
    pub(super) fn is_member(&self, other: AgentId) -> bool {
        other.kind == self.own.kind
    }

    /// Number of votes of other controllers with which it owns a goal.
    pub(super) fn votes_needed(&self) -> usize {
        self.settings.votes_needed() as usize
    }

    /// The time for which the next award of a goal waits, by the durations that messages have.
    pub(super) fn service_wait_s(&self) -> f64 {
        let lease_s = short(self.settings.service_lease_s);
        wait_s(lease_s.into(), self.settings.max_drift)
    }

    /// How long the leases of the robots of other controllers can last: a change of the scenario may have made them shorter.
    pub(super) fn takeover_wait_s(&self) -> f64 {
        self.service_wait_s().max(self.longest_wait_s)
    }

    pub(super) fn owner_wait_s(&self) -> f64 {
        let lease_s = short(self.settings.owner_lease_s);
        wait_s(lease_s.into(), self.settings.max_drift)
    }
}

/// A duration as it is in messages.
#[expect(clippy::cast_possible_truncation, reason = "messages are short")]
pub(super) fn short(duration_s: f64) -> f32 {
    duration_s as f32
}
