//! Events of goals, controllers and lanes: what agents hold before and after a step is compared.

use crate::judge::events::{EventKind, EventLog, GoalName};
use crate::radio::channel::Outgoing;
use crate::run::state::State;
use crate::scenario::Scenario;
use brain::{
    About, AgentId, ContractMessage, GoalId, LaneMessage, MarkVerdict, OwnershipMessage, Reason,
    TradeMessage,
};
use economy::LanePicture;
use std::collections::{BTreeMap, BTreeSet};

/// Notes events of agents for the readers of a run, if there are any.
#[derive(Debug, Clone, Default)]
pub(crate) struct AgentEvents {
    /// What agents held before the step; `None` after the run was moved or changed.
    before: Option<Held>,
}

impl AgentEvents {
    /// Notes what agents hold before a step.
    #[inline]
    pub(super) fn begin_step(&mut self, events: &EventLog, scenario: &Scenario, state: &State) {
        if events.has_readers() {
            self.before.get_or_insert_with(|| Held::of(scenario, state));
        }
    }

    /// Notes what has changed in a step of what they hold.
    #[inline]
    pub(super) fn end_step(&mut self, events: &EventLog, scenario: &Scenario, state: &State) {
        if !events.has_readers() {
            return;
        }
        let held = Held::of(scenario, state);
        for kind in self.before.iter().flat_map(|before| held.since(before)) {
            events.note(state.tick, kind);
        }
        self.before = Some(held);
    }

    /// Continues from another step, or with another scenario.
    pub(crate) fn forget(&mut self) {
        self.before = None;
    }
}

/// Notes what participants send in a step.
#[inline]
pub(super) fn note_sent<'m>(
    events: &EventLog,
    state: &State,
    outbox: impl Iterator<Item = &'m Outgoing>,
) {
    if !events.has_readers() {
        return;
    }
    for kind in outbox.filter_map(|outgoing| sent(state, outgoing)) {
        events.note(state.tick, kind);
    }
}

/// What agents hold, and what the judge has noted of goals, as far as a change of it is an event.
#[derive(Debug, Clone, Default)]
struct Held {
    /// By the kind and the index of the goal.
    goals: BTreeMap<(u8, u32), GoalState>,
    /// The robots to which controllers have awarded goals.
    awarded: BTreeMap<(AgentId, GoalName), AgentId>,
    lost: BTreeSet<(AgentId, GoalName)>,
    /// By the controller and the number of the mark.
    marks: BTreeMap<(AgentId, u32), Option<MarkVerdict>>,
    stated: BTreeMap<AgentId, (bool, Option<f64>)>,
    failed: BTreeSet<AgentId>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct GoalState {
    is_issued: bool,
    has_expired: bool,
    unserved: Option<Reason>,
}

impl Held {
    /// What agents hold at the current step of a run.
    fn of(scenario: &Scenario, state: &State) -> Self {
        let mut held = Self::default();
        for goal in state.each_goal(scenario) {
            let now = GoalState {
                is_issued: goal.issued_s.is_some(),
                has_expired: goal.has_expired,
                unserved: goal.unserved,
            };
            held.goals.insert((goal.kind, goal.index), now);
        }
        for agent in &state.controllers {
            let (by, controller) = (agent.participant.id, &agent.controller);
            if !agent.participant.is_working(&state.body_states) {
                held.failed.insert(by);
            }
            for goal in controller.goals() {
                if let Some((robot, _)) = goal.assignee {
                    let name = name_of(state, goal.task.id);
                    held.awarded.insert((by, name), robot);
                }
            }
            let lost = controller.lost();
            held.lost
                .extend(lost.map(|task| (by, name_of(state, task.id))));
            let marks = controller.lane().into_iter();
            let marks = marks.flat_map(LanePicture::mark_verdicts);
            held.marks
                .extend(marks.map(|(number, verdict)| ((by, number), verdict)));
            if let Some(is_clear) = agent.stated {
                let risk = controller.lane_statement().map(|stated| stated.risk);
                held.stated.insert(by, (is_clear, risk));
            }
        }
        held
    }

    /// What has happened since an earlier step.
    fn since(&self, before: &Self) -> Vec<EventKind> {
        let mut events = Vec::new();
        for (goal, now) in &self.goals {
            if let Some(was) = before.goals.get(goal) {
                events.extend(now.since(*was, *goal));
            }
        }
        let awarded = self.awarded.iter();
        let new = awarded.filter(|(key, to)| before.awarded.get(key) != Some(to));
        events.extend(new.map(|(&(by, goal), &to)| EventKind::Awarded { goal, by, to }));
        let lost = self.lost.difference(&before.lost);
        events.extend(lost.map(|&(by, goal)| EventKind::Lost { goal, by }));
        let marks = self.marks.iter();
        let new = marks.filter(|(key, verdict)| before.marks.get(key) != Some(verdict));
        events.extend(new.map(|(&(by, number), &verdict)| EventKind::Marked {
            by,
            number,
            verdict,
        }));
        let stated = self.stated.iter();
        let new = stated.filter(|(by, _)| !before.stated.contains_key(by));
        events.extend(new.map(|(&by, &(is_clear, risk))| EventKind::Stated { by, is_clear, risk }));
        let failed = self.failed.difference(&before.failed);
        events.extend(failed.map(|&controller| EventKind::Failed { controller }));
        events
    }
}

impl GoalState {
    fn since(self, before: Self, goal: (u8, u32)) -> impl Iterator<Item = EventKind> {
        let is_issued = self.is_issued && !before.is_issued;
        let has_expired = self.has_expired && !before.has_expired;
        let reason = self.unserved.filter(|_| self.unserved != before.unserved);
        let issued = is_issued.then_some(EventKind::Issued { goal });
        let unserved = reason.map(|reason| EventKind::Unserved { goal, reason });
        let expired = has_expired.then_some(EventKind::Expired { goal });
        issued.into_iter().chain(unserved).chain(expired)
    }
}

fn name_of(state: &State, id: GoalId) -> GoalName {
    let goal = state
        .goals
        .number(id)
        .map(|number| &state.goals.all[number]);
    let place = goal.map(|goal| (goal.kind, goal.index));
    GoalName { id, place }
}

/// The event that a participant sends a message that changes what another agent does or holds; `None` for offers,
/// renewals and information, which are repeated.
fn sent(state: &State, outgoing: &Outgoing) -> Option<EventKind> {
    let message = &outgoing.message;
    let (about, goal) = match &message.about {
        About::Contract(message) => of_contract(message)?,
        About::Ownership(message) => of_ownership(message)?,
        About::Trade(message) => of_trade(message)?,
        About::Lane(LaneMessage::Mark(_)) => ("mark", None),
        About::Lane(LaneMessage::Statement(_)) => ("statement on a mark", None),
        _ => return None,
    };
    let from = outgoing.from as usize;
    let controller = || state.controllers.get(from.checked_sub(state.ids.len())?);
    let robot = state.ids.get(from).copied();
    Some(EventKind::Sent {
        from: robot.or_else(|| Some(controller()?.participant.id))?,
        to: message.to,
        about,
        goal: goal.map(|id| name_of(state, id)),
    })
}

/// What a message about a contract is, and the goal that it is about.
fn of_contract(message: &ContractMessage) -> Option<(&'static str, Option<GoalId>)> {
    let (about, goal) = match message {
        ContractMessage::Award(award) => ("award", award.goal),
        ContractMessage::Commit(claim) => ("commitment", claim.goal),
        ContractMessage::Refuse(refusal) => ("refusal", refusal.goal),
        ContractMessage::Done(claim) => ("completion", claim.goal),
        ContractMessage::Stuck(refusal) => ("failure", refusal.goal),
        ContractMessage::Release(claim) => ("release", claim.goal),
        ContractMessage::Withdraw(claim) => ("withdrawal", claim.goal),
        _ => return None,
    };
    Some((about, Some(goal)))
}

/// The same for a message about the transfer of a goal.
fn of_trade(message: &TradeMessage) -> Option<(&'static str, Option<GoalId>)> {
    let (about, goal) = match message {
        TradeMessage::Price(price) => ("price", price.goal),
        TradeMessage::Transfer(transfer) => ("transfer", transfer.goal),
        _ => return None,
    };
    Some((about, Some(goal)))
}

/// The same for a message about the ownership of a goal.
fn of_ownership(message: &OwnershipMessage) -> Option<(&'static str, Option<GoalId>)> {
    let (about, goal) = match message {
        OwnershipMessage::Entrusted(vote) => ("vote", vote.goal),
        OwnershipMessage::Release(claim) => ("release of the vote", claim.goal),
        OwnershipMessage::Ended(goal) => ("end of the goal", *goal),
        _ => return None,
    };
    Some((about, Some(goal)))
}
