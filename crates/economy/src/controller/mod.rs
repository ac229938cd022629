//! A controller: it owns goals, and awards them to robots.
//!
//! * [`owned`]: the goals; [`picture`]: the robots, as they report themselves; [`bids`]: what they bid;
//! * [`receive`]: the effect of each message;
//! * [`auction`]: calls and awards, in each [`round`]; [`arbitration`]: whether a robot keeps a goal; [`lapses`]: robots
//!   that fell silent;
//!   [`displacement`]: valuable goals before others;
//!   [`unserved`]: goals that no robot can serve;
//! * [`heirs`]: owner leases, with the two halves [`tenures`] (owner) and [`estates`] (heir);
//!   [`wards`]: goals of lost owners; [`reports`]: what the operator is to know;
//!   [`colleagues`]: the other controllers, by their [`presence`];
//! * [`clearing`]: the goals of a mined lane, [`lane_work`], their state, and [`tried`], searches in vain;
//!   [`conclusion`]: what it states beside the risk, by [`concluding`].

mod arbitration;
mod auction;
mod bids;
mod clearing;
mod colleagues;
mod concluding;
mod conclusion;
mod displacement;
mod estates;
mod heirs;
mod lane_work;
mod lapses;
mod owned;
mod picture;
mod presence;
mod receive;
mod reports;
mod round;
mod tenures;
mod tried;
mod trust;
mod unserved;
mod wards;

pub(crate) use auction::{CALLS_PER_STEP, REPEAT_S};
pub use conclusion::LaneConclusion;
pub use tenures::RENEWAL_RETRY_S;

use crate::clearance::{LanePicture, LaneStatement};
use crate::settings::Settings;
use alloc::sync::Arc;
use alloc::vec::Vec;
use base::hashed::Hashed;
use bids::Bids;
use brain::{
    About, Claim, Command, Dispatch, GoalId, Grantor, Holder, Message, Numbers, Percept, Receiver,
    Refusal,
};
use brain::{AgentId, Reason, Task, wait_s};
use colleagues::Colleagues;
use lane_work::Clearing;
use owned::{Heir, Owned};
use picture::Picture;
use reports::Reports;
use round::Round;
use wards::{Orphan, Ward};

/// The number of no bid: those of agents begin at 1.
const NO_BID: u32 = 0;

/// One controller: it owns goals, and awards them to robots.
#[derive(Debug, Clone, Hashed)]
pub struct Controller {
    #[hashed(skip)]
    settings: Arc<Settings>,
    own: AgentId,
    /// Its clock, and the time since the last step.
    now_s: f64,
    step_s: f64,
    /// Until when it grants nothing, once it knows the time: an agent that restarts does not know
    /// what it granted before.
    silent_until_s: Option<f64>,
    numbers: Numbers,
    goals: Vec<Owned>,
    /// Goals of which it is the heir, and goals that it owned until their lease ended.
    wards: Vec<Ward>,
    orphans: Vec<Orphan>,
    /// Service leases that it has granted, owner leases that it has granted, and those that it holds.
    services: Grantor,
    estates: Grantor,
    tenures: Holder,
    picture: Picture,
    colleagues: Colleagues,
    bids: Bids,
    round: Round,
    next_renewal_s: f64,
    reports: Reports,
    refused: u32,
    awards: u32,
    lapses: u32,
    clearing: Clearing,
    #[hashed(skip)]
    outbox: Vec<Message>,
}

/// A goal that a controller owns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnedGoal {
    /// The goal.
    pub task: Task,
    /// The robot that serves it, and the remaining time of its lease in seconds; `None` if there is none.
    pub assignee: Option<(AgentId, f64)>,
    /// The controller that renews the lease of the owner and inherits the goal, and the remaining time
    /// of that lease in seconds; `None` if there is none: the controller then owns the goal without a
    /// lease.
    pub heir: Option<(AgentId, f64)>,
    /// Why no robot can serve it at present, if that is so.
    pub unserved: Option<Reason>,
}

impl Controller {
    /// A controller at the start of a mission: no robot holds a lease of it.
    #[must_use]
    pub fn new(settings: Arc<Settings>) -> Self {
        Self {
            clearing: Clearing::new(settings.clearance.as_ref()),
            settings,
            own: AgentId::default(),
            now_s: f64::NEG_INFINITY,
            step_s: 0.0,
            silent_until_s: Some(f64::NEG_INFINITY),
            numbers: Numbers::default(),
            goals: Vec::new(),
            wards: Vec::new(),
            orphans: Vec::new(),
            services: Grantor::default(),
            estates: Grantor::default(),
            tenures: Holder::default(),
            picture: Picture::default(),
            colleagues: Colleagues::default(),
            bids: Bids::default(),
            round: Round::default(),
            next_renewal_s: f64::NEG_INFINITY,
            reports: Reports::default(),
            refused: 0,
            awards: 0,
            lapses: 0,
            outbox: Vec::new(),
        }
    }

    /// A controller that is switched on again during a mission: it remembers nothing, and grants
    /// nothing for the longest lease.
    #[must_use]
    pub fn restarted(settings: Arc<Settings>) -> Self {
        Self {
            silent_until_s: None,
            ..Self::new(settings)
        }
    }

    /// The controller with the settings of another one, and its own memory.
    #[must_use]
    pub fn with_settings_of(&self, other: &Self) -> Self {
        let is_same_lane = self.settings.clearance == other.settings.clearance;
        let clearing = if is_same_lane {
            self.clearing.clone()
        } else {
            Clearing::new(other.settings.clearance.as_ref())
        };
        Self {
            settings: other.settings.clone(),
            clearing,
            ..self.clone()
        }
    }

    /// The command for a percept, of which it uses time, id, position, neighbours and inbox.
    ///
    /// A percept from before the last one changes nothing.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        command.outbox.clear();
        command.acts.clear();
        let time_s = percept.time_s.filter(|time_s| time_s.is_finite());
        let now_s = time_s.unwrap_or(self.now_s.max(0.0));
        if now_s < self.now_s {
            return;
        }
        self.step_s = (now_s - self.now_s).min(1.0);
        (self.now_s, self.own) = (now_s, percept.id);
        let silent_s = self.longest_wait_s();
        self.silent_until_s.get_or_insert(now_s + silent_s);
        self.expire();
        for received in &percept.inbox {
            self.receive(received, percept);
        }
        self.sense(percept);
        self.present(percept);
        command.acts.extend(self.clear(percept));
        self.call();
        self.award();
        self.arbitrate();
        self.call_full_robots();
        self.probe();
        self.settle_heirs(percept);
        for report in self.reports.due(now_s) {
            self.send(AgentId::OPERATOR, report);
        }
        self.outbox.sort_by_key(Message::urgency);
        command.outbox.append(&mut self.outbox);
    }

    /// The goals that it owns and that are not done, in the order in which it received them.
    pub fn goals(&self) -> impl Iterator<Item = OwnedGoal> {
        let open = self.goals.iter().filter(|owned| !owned.is_done);
        open.map(|owned| OwnedGoal {
            task: owned.task,
            assignee: self.services.grant_of(owned.task.id).map(|grant| {
                let left_s = (grant.until_s - self.now_s).max(0.0);
                (grant.holder, left_s)
            }),
            heir: owned.heir.bound().map(|heir| {
                let lease = self.tenures.lease(owned.task.id);
                (heir, lease.map_or(0.0, |lease| lease.until_s - self.now_s))
            }),
            unserved: owned.unserved(self.now_s),
        })
    }

    /// The goals that it owned and that have been served.
    pub fn done(&self) -> impl Iterator<Item = GoalId> {
        let done = self.goals.iter().filter(|owned| owned.is_done);
        done.map(|owned| owned.task.id)
    }

    /// The goals that it owned until their lease ended, because the heir did not renew it.
    pub fn orphans(&self) -> impl Iterator<Item = Task> {
        self.orphans.iter().map(|orphan| orphan.owned.task)
    }

    /// Whether it owns a goal at a time on its clock, which is not before its last step.
    #[must_use]
    pub fn owns_at(&self, goal: GoalId, time_s: f64) -> bool {
        let mut goals = self.goals.iter();
        let owned = goals.find(|owned| owned.task.id == goal && !owned.is_done);
        owned
            .is_some_and(|owned| owned.heir.bound().is_none() || self.tenures.is_held(goal, time_s))
    }

    /// Whether it owns a goal, is the heir to which its owner is bound, has lost it, or reports it to the operator.
    #[must_use]
    pub fn knows(&self, goal: GoalId) -> bool {
        let owned = self.goals.iter().map(|owned| owned.task.id);
        let wards = self.wards.iter().filter(|ward| ward.is_bound);
        let wards = wards.map(|ward| ward.task.id);
        let orphans = self.orphans.iter().map(|orphan| orphan.owned.task.id);
        let mut known = owned.chain(wards).chain(orphans);
        known.any(|id| id == goal) || self.reports.contains(goal)
    }

    /// Number of goals that it refused because it owned the maximum number.
    #[must_use]
    pub fn refused(&self) -> u32 {
        self.refused
    }

    /// Number of awards, repeated ones not counted.
    #[must_use]
    pub fn awards(&self) -> u32 {
        self.awards
    }

    /// Number of service leases that ended because the robot was silent.
    #[must_use]
    pub fn lapses(&self) -> u32 {
        self.lapses
    }

    /// What it believes of the lane that it is to clear, if there is one.
    #[must_use]
    pub fn lane(&self) -> Option<&LanePicture> {
        self.clearing.picture()
    }

    /// Whether a mark of the lane that may be a mine had no verdict when it last planned.
    #[must_use]
    pub fn has_open_marks(&self) -> bool {
        let work = self.clearing.work.as_ref();
        work.is_some_and(|work| work.has_open_marks)
    }

    /// Whether a person has ended its mission on the lane.
    #[must_use]
    pub fn is_called_off(&self) -> bool {
        self.settings.is_called_off
    }

    /// What it has stated about the lane, if it has.
    #[must_use]
    pub fn lane_statement(&self) -> Option<LaneStatement> {
        self.clearing.statement()
    }

    /// Takes a goal that a person has issued.
    fn take_issued(&mut self, task: Task) {
        self.reports.remove(task.id);
        if let Err(reason) = self.own(task) {
            self.refused += 1;
            let (goal, number) = (task.id, 0);
            let refusal = Refusal {
                goal,
                number,
                reason,
            };
            self.reports.put_refused(refusal, self.now_s);
        }
    }

    /// Owns a goal that a person has issued, or that it has planned.
    fn own(&mut self, task: Task) -> Result<(), Reason> {
        if self.goals.iter().any(|owned| owned.task.id == task.id) {
            return Ok(());
        }
        if !task.is_valid() {
            return Err(Reason::Invalid);
        }
        let was_orphan = self
            .orphans
            .iter()
            .any(|orphan| orphan.owned.task.id == task.id);
        let open = self.goals.iter().filter(|owned| owned.is_open(self.now_s));
        let open = open.count();
        if open >= self.settings.max_goals as usize {
            return Err(Reason::Full);
        }
        let wait_s = if was_orphan {
            self.service_wait_s()
        } else {
            0.0
        };
        self.orphans
            .retain(|orphan| orphan.owned.task.id != task.id);
        self.goals.push(Owned::new(task, self.now_s, wait_s));
        Ok(())
    }

    /// Ends what has ended by the clock.
    fn expire(&mut self) {
        for grant in self.services.expire(self.now_s) {
            self.lost_assignee(grant.goal, grant.holder);
        }
        self.expire_tenures();
        self.inherit();
        self.bids.expire(self.now_s);
        self.picture.expire(self.now_s);
        self.colleagues.expire(self.now_s);
    }

    fn goal_mut(&mut self, goal: GoalId) -> Option<&mut Owned> {
        let mut goals = self.goals.iter_mut();
        goals.find(|owned| owned.task.id == goal)
    }

    fn send(&mut self, to: impl Into<Receiver>, dispatch: Dispatch) {
        self.outbox.push(Message::to(to, About::Dispatch(dispatch)));
    }

    /// Whether it grants leases: not before the longest lease of an earlier life has ended.
    fn may_grant(&self) -> bool {
        self.silent_until_s
            .is_some_and(|until_s| self.now_s >= until_s)
    }

    /// The time for which the next award of a goal waits, by the durations that messages have.
    fn service_wait_s(&self) -> f64 {
        wait_s(
            short(self.settings.service_lease_s).into(),
            self.settings.max_drift,
        )
    }

    fn owner_wait_s(&self) -> f64 {
        wait_s(
            short(self.settings.owner_lease_s).into(),
            self.settings.max_drift,
        )
    }

    fn longest_wait_s(&self) -> f64 {
        self.service_wait_s().max(self.owner_wait_s())
    }

    /// A goal is no longer on offer, except to the robot whose bid has a number.
    fn close_offer(&mut self, goal: GoalId, number: u32) {
        let claim = Claim { goal, number };
        self.send(Receiver::All, Dispatch::Withdraw(claim));
    }
}

/// A duration as it is in messages.
#[expect(clippy::cast_possible_truncation, reason = "messages are short")]
fn short(duration_s: f64) -> f32 {
    duration_s as f32
}

/// The part of an heir that [`OwnedGoal`] shows.
impl Heir {
    fn bound(&self) -> Option<AgentId> {
        match self {
            Self::Bound { heir, .. } | Self::Relieving { heir, .. } => Some(*heir),
            Self::None | Self::Offered { .. } => None,
        }
    }
}
