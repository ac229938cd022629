//! A controller: it owns goals, and awards them to robots.
//!
//! * [`context`]: what its parts share: clock, outbox, the [`ledger`] of its goals, the [`robots`] and [`peers`] in range;
//! * [`presence`]: it reports to other controllers that it is in range;
//! * [`contracts`]: goals are offered to robots, and awarded;
//! * [`ownership`]: goals are handed over between controllers, by the [`handover`] protocol;
//! * [`trade`]: goals go to the controller that can have them served;
//! * [`missions`]: missions for which it plans goals itself.

mod context;
mod contracts;
mod handover;
mod ledger;
mod missions;
mod ownership;
mod peers;
mod presence;
mod robots;
mod trade;

pub(crate) use contracts::{CALLS_PER_STEP, REPEAT_S};
pub(crate) use handover::{CANDIDACY_S, RETRY_S, TURN_S};
pub use missions::lane::LaneConclusion;
pub(crate) use ownership::MAX_MESSAGES;
pub use ownership::RENEWAL_RETRY_S;

use crate::clearance::{LanePicture, LaneStatement};
use crate::passage::PlannedPassage;
use crate::settings::Settings;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{
    About, AgentId, AgentRole, Command, ContractMessage, GoalId, LaneMessage, Message,
    OwnershipMessage, Percept, Reason, ReceivedMessage, Task,
};
use context::Context;
use contracts::Contracts;
use missions::lane::LaneMission;
use ownership::Ownership;
use presence::Presence;
use trade::Trading;

/// One controller: it owns goals, and awards them to robots.
#[derive(Debug, Clone, Hashed)]
pub struct Controller {
    context: Context,
    presence: Presence,
    contracts: Contracts,
    ownership: Ownership,
    trading: Trading,
    lane: LaneMission,
}

/// A goal that a controller owns.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnedGoal {
    /// The goal.
    pub task: Task,
    /// The robot that serves it, and the remaining time of its lease in seconds; `None` if there is none.
    pub assignee: Option<(AgentId, f64)>,
    /// The controllers that vote for it as the owner.
    pub votes: Vec<AgentId>,
    /// The remaining time in seconds for which a majority does; `None` if it owns the goal alone.
    pub owner_lease_s: Option<f64>,
    /// Why no robot can serve it at present, if that is so.
    pub unserved: Option<Reason>,
}

impl Controller {
    /// A controller at the start of a mission: no robot holds a lease of it.
    #[must_use]
    pub fn new(settings: Arc<Settings>) -> Self {
        Self {
            lane: LaneMission::new(settings.clearance.as_ref()),
            context: Context::new(settings),
            presence: Presence::default(),
            contracts: Contracts::default(),
            ownership: Ownership::default(),
            trading: Trading::default(),
        }
    }

    /// A controller that is switched on again during a mission: it remembers nothing, and grants
    /// nothing for the longest lease.
    #[must_use]
    pub fn restarted(settings: Arc<Settings>) -> Self {
        Self {
            context: Context::restarted(settings.clone()),
            ..Self::new(settings)
        }
    }

    /// The controller with the settings of another one, and its own memory. If controllers of its kind own goals alone from now
    /// on, it forgets those that it does not own.
    #[must_use]
    pub fn with_settings_of(&self, other: &Self) -> Self {
        let settings = &other.context.settings;
        let is_same_lane = self.context.settings.clearance == settings.clearance;
        let mut changed = self.clone();
        let had_members = changed.context.votes_needed() > 0;
        let is_same_kind = changed.context.set(settings.clone());
        if !is_same_kind {
            changed.trading.void_prices();
        }
        if had_members && changed.context.votes_needed() == 0 {
            let (context, contracts) = (&mut changed.context, &mut changed.contracts);
            changed.ownership.own_alone(context, contracts);
        }
        if !is_same_lane {
            changed.lane = LaneMission::new(settings.clearance.as_ref());
        }
        changed
    }

    /// Waits as long as another one after a takeover: it joins during a mission, in which leases may have been longer.
    pub fn join(&mut self, others: &Self) {
        self.context.wait_as(&others.context);
    }

    /// Forgets controllers that a person has removed: they own no goal, and their votes do not count.
    pub fn forget_peers(&mut self, is_removed: impl Fn(AgentId) -> bool) {
        self.ownership.forget_peers(&mut self.context, &is_removed);
        self.context.forget_peers(&is_removed);
        self.trading.forget_peers(is_removed);
    }

    /// The command for a percept, of which it uses time, id, position, neighbours and inbox.
    ///
    /// A percept from before the last one changes nothing.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        command.outbox.clear();
        command.acts.clear();
        if !self.context.begin(percept) {
            return;
        }
        self.contracts.expire(&mut self.context);
        self.ownership.expire(&mut self.context);
        for received in &percept.inbox {
            self.receive(received);
        }
        self.presence.step(&mut self.context, percept);
        let act = self.lane.step(&mut self.context, &mut self.contracts);
        command.acts.extend(act);
        self.ownership
            .settle(&mut self.context, &mut self.contracts);
        self.contracts.step(&mut self.context);
        self.trading
            .step(&mut self.context, &mut self.contracts, &mut self.ownership);
        self.ownership.step(&mut self.context);
        self.context.send_reports();
        let outbox = &mut self.context.outbox;
        outbox.sort_by_key(Message::urgency);
        command.outbox.append(outbox);
    }

    fn receive(&mut self, received: &ReceivedMessage) {
        let ReceivedMessage { from, message, .. } = received;
        match from.role {
            AgentRole::Person => self.receive_of_person(&message.about),
            AgentRole::Robot => self.receive_of_robot(*from, message),
            AgentRole::Controller if *from == self.context.own => {}
            AgentRole::Controller => self.receive_of_peer(*from, message),
        }
    }

    fn receive_of_person(&mut self, about: &About) {
        match *about {
            About::Contract(ContractMessage::Issue(task)) => {
                self.ownership.take_issued(&mut self.context, task);
            }
            About::Contract(ContractMessage::Acknowledge(goal)) => {
                self.context.ledger.reports.remove(goal);
            }
            _ => {}
        }
    }

    fn receive_of_robot(&mut self, from: AgentId, message: &Message) {
        let context = &mut self.context;
        match message.about {
            About::Contract(about) => {
                if let ContractMessage::Done(claim) = about {
                    self.ownership.restore_done(context, from, claim.goal);
                }
                let answer = (&about, message.confidence);
                if !self.trading.take_answer(context, from, answer) {
                    self.contracts
                        .receive(context, from, about, message.confidence);
                }
            }
            About::Lease(about) => self.contracts.renew(context, from, about),
            About::Lane(about) => self.lane.receive(from, &about),
            _ => {}
        }
    }

    fn receive_of_peer(&mut self, from: AgentId, message: &Message) {
        let context = &mut self.context;
        match message.about {
            About::Ownership(OwnershipMessage::Present {}) => {
                context.peers.note(from, context.now_s);
            }
            About::Ownership(OwnershipMessage::Seen(seen)) => {
                let at = Point::from(seen.at_m.map(f64::from));
                let now_s = context.now_s;
                context
                    .robots
                    .see(seen.robot, at, message.confidence, now_s);
            }
            About::Ownership(about) if context.is_member(from) => {
                if let OwnershipMessage::Ended(goal) = about {
                    self.trading.note_end(context, from, goal);
                }
                self.ownership
                    .receive(context, &mut self.contracts, from, about);
            }
            About::Trade(about) if context.is_member(from) => {
                let about = (about, message.confidence);
                self.trading
                    .receive(context, &mut self.ownership, from, about);
            }
            About::Lease(about) if context.is_member(from) => {
                self.ownership.renew(context, from, about);
            }
            About::Lane(LaneMessage::Gain(gain)) => context.peers.note_lane_gain(from, gain.into()),
            _ => {}
        }
    }

    /// The goals that it owns and that are not done, in the order in which it received them.
    pub fn goals(&self) -> impl Iterator<Item = OwnedGoal> {
        let (ledger, now_s) = (&self.context.ledger, self.context.now_s);
        let open = ledger
            .goals
            .iter()
            .filter(move |owned| owned.is_held(now_s));
        open.map(move |owned| OwnedGoal {
            task: owned.task,
            assignee: self.contracts.assignee(owned.task.id, now_s),
            votes: ledger
                .votes_for(owned.task.id)
                .map(|(voter, _)| voter)
                .collect(),
            owner_lease_s: Some(owned.held_until_s - now_s).filter(|lease_s| lease_s.is_finite()),
            unserved: owned.unserved(now_s),
        })
    }

    /// The goals that it owned and that have been served.
    pub fn done(&self) -> impl Iterator<Item = GoalId> {
        let goals = &self.context.ledger.goals;
        let done = goals.iter().filter(|owned| owned.is_done);
        done.map(|owned| owned.task.id)
    }

    /// The goals for which it has reported that it does not own them, as no majority votes for it, and of which it knows no
    /// other owner.
    pub fn lost(&self) -> impl Iterator<Item = Task> {
        let candidates = self.context.ledger.lost();
        self.ownership.lost().chain(candidates)
    }

    /// Whether it owns a goal at a time on its clock, which is not before its last step.
    #[must_use]
    pub fn owns_at(&self, goal: GoalId, time_s: f64) -> bool {
        self.context.ledger.owns_at(goal, time_s)
    }

    /// Whether it owns a goal that is not done, is a candidate for it, keeps its description as a voter, or reports it to the
    /// operator.
    #[must_use]
    pub fn knows(&self, goal: GoalId) -> bool {
        let ledger = &self.context.ledger;
        let is_own = ledger.has_undone(goal);
        let is_reported = ledger.reports.goals().any(|reported| reported == goal);
        is_own || is_reported || self.ownership.knows(goal)
    }

    /// Number of goals that it has transferred to other controllers.
    #[must_use]
    pub fn transfers(&self) -> u32 {
        self.trading.transfers()
    }

    /// Number of goals that it refused because it owned the maximum number.
    #[must_use]
    pub fn refused(&self) -> u32 {
        self.context.ledger.refused
    }

    /// Number of awards, repeated ones not counted.
    #[must_use]
    pub fn awards(&self) -> u32 {
        self.contracts.awards
    }

    /// Number of service leases that ended because the robot was silent.
    #[must_use]
    pub fn lapses(&self) -> u32 {
        self.contracts.lapses
    }

    /// What it believes of the lane that it is to clear, if there is one.
    #[must_use]
    pub fn lane(&self) -> Option<&LanePicture> {
        self.lane.picture()
    }

    /// Whether a mark of the lane that may be a mine had no verdict when it last planned.
    #[must_use]
    pub fn has_open_marks(&self) -> bool {
        self.lane.has_open_marks()
    }

    /// Whether a person has ended its mission on the lane.
    #[must_use]
    pub fn is_called_off(&self) -> bool {
        self.context.settings.is_called_off
    }

    /// What it has stated about the lane, if it has.
    #[must_use]
    pub fn lane_statement(&self) -> Option<LaneStatement> {
        self.lane.statement()
    }

    /// What it has stated of the lane beside the risk; if it has stated nothing, what it would state now. `None` without
    /// a lane.
    #[must_use]
    pub fn lane_conclusion(&self) -> Option<LaneConclusion> {
        let passage = self.context.settings.passage.as_deref();
        self.lane.conclusion(passage)
    }

    /// The passage that it has stated.
    #[must_use]
    pub fn stated_passage(&self) -> Option<&PlannedPassage> {
        self.lane.stated_passage()
    }
}
