//! A controller: it owns goals, and awards them to robots.
//!
//! * [`context`]: what its parts share: clock, outbox, the [`ledger`] of its goals, the [`robots`] and [`peers`] in range;
//! * [`presence`]: it reports to peers that it is in range;
//! * [`contracts`]: goals are offered to robots, and awarded;
//! * [`ownership`]: goals are handed over between controllers, by the [`handover`] protocol;
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

pub(crate) use contracts::{CALLS_PER_STEP, REPEAT_S};
pub use missions::lane::LaneConclusion;
pub use ownership::RENEWAL_RETRY_S;

use crate::clearance::{LanePicture, LaneStatement};
use crate::passage::PlannedPassage;
use crate::settings::Settings;
use alloc::sync::Arc;
use base::geometry::Point;
use base::hashed::Hashed;
use brain::{
    About, AgentId, AgentRole, Command, ContractMessage, GoalId, LaneMessage, Message,
    OwnershipMessage, Percept, Reason, ReceivedMessage, Task,
};
use context::Context;
use contracts::Contracts;
use handover::Handover;
use missions::lane::LaneMission;
use ownership::Ownership;
use presence::Presence;

/// One controller: it owns goals, and awards them to robots.
#[derive(Debug, Clone, Hashed)]
pub struct Controller {
    context: Context,
    presence: Presence,
    contracts: Contracts,
    ownership: Ownership,
    lane: LaneMission,
}

/// A goal that a controller owns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnedGoal {
    /// The goal.
    pub task: Task,
    /// The robot that serves it, and the remaining time of its lease in seconds; `None` if there is none.
    pub assignee: Option<(AgentId, f64)>,
    /// The controller that renews the lease of the owner and takes the goal over when it ends, and the remaining time
    /// of that lease in seconds; `None` if there is none: the controller then owns the goal without a
    /// lease.
    pub backup: Option<(AgentId, f64)>,
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

    /// The controller with the settings of another one, and its own memory.
    #[must_use]
    pub fn with_settings_of(&self, other: &Self) -> Self {
        let settings = &other.context.settings;
        let is_same_lane = self.context.settings.clearance == settings.clearance;
        let mut changed = self.clone();
        changed.context.settings = settings.clone();
        if !is_same_lane {
            changed.lane = LaneMission::new(settings.clearance.as_ref());
        }
        changed
    }

    /// Forgets peers that a person has removed: they take over no goal any more.
    pub fn forget_peers(&mut self, is_removed: impl Fn(AgentId) -> bool) {
        self.context.peers.list.retain(|peer| !is_removed(peer.id));
        let ledger = &mut self.context.ledger;
        for owned in &mut ledger.goals {
            if owned.handover.bound().is_some_and(&is_removed) {
                ledger.leases.release(owned.task.id);
                owned.handover = Handover::Alone;
            }
        }
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
        self.ownership
            .expire(&mut self.context, &mut self.contracts);
        for received in &percept.inbox {
            self.receive(received);
        }
        self.presence.step(&mut self.context, percept);
        let act = self.lane.step(&mut self.context, &mut self.contracts);
        command.acts.extend(act);
        self.contracts.step(&mut self.context);
        self.ownership.step(&mut self.context, &self.contracts);
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
                self.contracts
                    .receive(context, from, about, message.confidence);
            }
            About::Lease(about) => self.contracts.renew(context, from, about),
            About::Lane(about) => self.lane.receive(from, &about),
            _ => {}
        }
    }

    fn receive_of_peer(&mut self, from: AgentId, message: &Message) {
        let context = &mut self.context;
        match message.about {
            About::Ownership(OwnershipMessage::Serial(serial)) => {
                context.peers.note(from, serial, context.now_s);
            }
            About::Ownership(OwnershipMessage::Seen(seen)) => {
                let at = Point::from(seen.at_m.map(f64::from));
                let now_s = context.now_s;
                context
                    .robots
                    .see(seen.robot, at, message.confidence, now_s);
            }
            About::Ownership(about) => {
                self.ownership
                    .receive(context, &mut self.contracts, from, about);
            }
            About::Lease(about) => self.ownership.renew(context, from, about),
            About::Lane(LaneMessage::Gain(gain)) => context.peers.note_lane_gain(from, gain.into()),
            _ => {}
        }
    }

    /// The goals that it owns and that are not done, in the order in which it received them.
    pub fn goals(&self) -> impl Iterator<Item = OwnedGoal> {
        let (ledger, now_s) = (&self.context.ledger, self.context.now_s);
        let open = ledger.goals.iter().filter(|owned| !owned.is_done);
        open.map(move |owned| OwnedGoal {
            task: owned.task,
            assignee: self.contracts.assignee(owned.task.id, now_s),
            backup: owned.handover.bound().map(|backup| {
                let lease = ledger.leases.lease(owned.task.id);
                (backup, lease.map_or(0.0, |lease| lease.until_s - now_s))
            }),
            unserved: owned.unserved(now_s),
        })
    }

    /// The goals that it owned and that have been served.
    pub fn done(&self) -> impl Iterator<Item = GoalId> {
        let goals = &self.context.ledger.goals;
        let done = goals.iter().filter(|owned| owned.is_done);
        done.map(|owned| owned.task.id)
    }

    /// The goals that it owned until their lease ended, because the backup did not renew it.
    pub fn lost(&self) -> impl Iterator<Item = Task> {
        self.ownership.lost()
    }

    /// Whether it owns a goal at a time on its clock, which is not before its last step.
    #[must_use]
    pub fn owns_at(&self, goal: GoalId, time_s: f64) -> bool {
        self.context.ledger.owns_at(goal, time_s)
    }

    /// Whether it owns a goal that is not done, is the backup to which its owner is bound, has lost it, or reports it to the
    /// operator.
    #[must_use]
    pub fn knows(&self, goal: GoalId) -> bool {
        let ledger = &self.context.ledger;
        let is_own = ledger.has_undone(goal);
        let is_reported = ledger.reports.goals().any(|reported| reported == goal);
        is_own || is_reported || self.ownership.knows(goal)
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
