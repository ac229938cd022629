//! Goals are issued when they arrive, and stay when a run continues with another scenario.

use super::operator::order_to;
use super::state::State;
use crate::goals::placed::{Goal, Goals};
use crate::judge::goal_tally::GoalTally;
use crate::scenario::Scenario;
use crate::schedule::steps_of;
use brain::{AgentId, ContractMessage, GoalId, Reason, ReceivedMessage, wait_s};
use std::collections::{BTreeMap, BTreeSet};

impl State {
    /// Issues the goals that arrive in this step, or that have lost their controller.
    pub(crate) fn issue_goals(&mut self, scenario: &Scenario) {
        while let Some(number) = self.goals.next_arrival(self.tick) {
            self.issue(scenario, number);
        }
    }

    /// The goals that the next step issues: the number of the controller, and the order that it receives.
    pub(crate) fn orders_due(&self, scenario: &Scenario) -> Vec<(usize, ReceivedMessage)> {
        let due = self.goals.due(self.tick);
        let orders = due.filter_map(|number| {
            let owner = self.owner_of(scenario, number)?;
            let id = self.controllers[owner].participant.id;
            Some((owner, order_to(id, self.issue_of(scenario, number))))
        });
        orders.collect()
    }

    /// The order to own a goal.
    fn issue_of(&self, scenario: &Scenario, number: usize) -> ContractMessage {
        let goal = &self.goals.all[number];
        let kind = &scenario.goals[usize::from(goal.kind)];
        ContractMessage::Issue(kind.task(goal.id, goal.at))
    }

    fn issue(&mut self, scenario: &Scenario, number: usize) {
        let goal = &self.goals.all[number];
        let has_owners = scenario.first_owner(goal).is_some();
        let owner = self.owner_of(scenario, number);
        let Some(tally) = &mut self.tally.goals else {
            return;
        };
        let record = &mut tally.records[number];
        if record.served.is_some() {
            return;
        }
        record.issued_at.get_or_insert(self.tick);
        let Some(owner) = owner else {
            record.unserved = has_owners.then_some(Reason::NoController);
            return;
        };
        record.issued_to = Some(self.controllers[owner].participant.id);
        record.unserved = None;
        self.order(self.robots() + owner, self.issue_of(scenario, number));
    }

    /// The number of the controller that a goal is issued to. If the first one does not work, or has refused it, it is the
    /// next one of its kind that does, and then one of another kind; `None` if none works.
    fn owner_of(&self, scenario: &Scenario, goal: usize) -> Option<usize> {
        let (first, count) = scenario.first_owner(&self.goals.all[goal])?;
        let participants = self.controllers.iter().map(|agent| &agent.participant);
        let start = participants.take_while(|each| each.id.kind < first.kind);
        let (start, all) = (start.count(), self.controllers.len());
        let [index, count] = [first.index as usize, count as usize];
        let own_kind = (0..count).map(|step| start + (index + step) % count);
        let others = (count..all).map(|step| (start + step) % all);
        let is_working = |owner: &usize| {
            let participant = &self.controllers[*owner].participant;
            participant.is_working(&self.body_states)
        };
        let working: Vec<usize> = own_kind.chain(others).filter(is_working).collect();
        let turn = self.goals.refusals(goal).checked_rem(working.len())?;
        Some(working[turn])
    }

    /// Takes over the goals that stay, and the journeys of robots from their `old` numbers.
    pub(super) fn keep_goals(
        &mut self,
        (before, from): (&Self, &Scenario),
        to: &Scenario,
        old: &[Option<usize>],
        ids: &BTreeMap<AgentId, AgentId>,
    ) {
        let Some(mut tally) = self.tally.goals.take() else {
            return;
        };
        let numbers = before.tally.goals.as_ref().map(|was| {
            let numbers = self.keep_places((before, from), to);
            tally.take_over(was, &numbers, old, ids);
            numbers
        });
        let is_issued = |number: usize| tally.records[number].issued_at.is_some();
        self.goals
            .keep_waiting(&before.goals, &numbers.unwrap_or_default(), is_issued);
        self.tally.goals = Some(tally);
    }

    /// Notes the goals that robots had and have forgotten, because a change has replaced their brains.
    pub(super) fn note_forgotten(&mut self, before: &Self) {
        let had = before.goals_of_robots();
        let have = self.goals_of_robots();
        let forgotten: Vec<usize> = had
            .difference(&have)
            .filter_map(|goal| self.goals.number(*goal))
            .collect();
        let Some(tally) = &mut self.tally.goals else {
            return;
        };
        for number in forgotten {
            tally.records[number].returned.get_or_insert(Reason::Lease);
        }
    }

    /// The goals that working robots have been awarded, or are to report to the operator.
    fn goals_of_robots(&self) -> BTreeSet<GoalId> {
        let goals = self.working_robots().flat_map(|(_, agent)| {
            let served = agent.brain.served_goals().into_iter();
            let served = served.map(|served| served.task.id);
            served
                .chain(agent.brain.returned_goals())
                .collect::<Vec<_>>()
        });
        goals.collect()
    }

    /// Issues goals again that no controller knows since a change: those that knew them were removed, or restarted because
    /// ids have changed. A goal that a robot serves under a lease of one of them waits until that has ended, for a number
    /// of steps.
    pub(super) fn reissue_forgotten(
        &mut self,
        before: &Self,
        to: &Scenario,
        forgetful: &[usize],
        lease: u64,
    ) {
        let held = self.goals_of_robots();
        for number in 0..self.goals.all.len() {
            let (id, record) = (self.goals.all[number].id, self.goal_record(number));
            let is_open = record.issued_at.is_some() && record.served.is_none();
            if !is_open || self.goals.is_waiting(number) {
                continue;
            }
            let knowing = self.knowing_controller(id, None);
            // Of controllers that own goals alone from now on, voters forget them.
            let is_unknown = knowing.is_none() && before.knowing_controller(id, None).is_some();
            let is_forgotten = before.is_known_to(forgetful, id) || record.issued_to.is_none();
            if !is_forgotten && !is_unknown {
                continue;
            }
            let issued_to = knowing.map(|number| self.controllers[number].participant.id);
            if let Some(tally) = &mut self.tally.goals {
                tally.records[number].issued_to = issued_to;
            }
            if issued_to.is_none() && self.owner_of(to, number).is_some() {
                let wait = if held.contains(&id) || !is_forgotten {
                    lease
                } else {
                    0
                };
                self.goals.issue_again(number, self.tick + wait);
            }
        }
    }

    /// Keeps ids and places of goals by the names of their kinds and their indices; returns their numbers now, by
    /// those before.
    fn keep_places(
        &mut self,
        (before, from): (&Self, &Scenario),
        to: &Scenario,
    ) -> BTreeMap<usize, usize> {
        let name = |scenario: &Scenario, goal: &Goal| {
            let kind = &scenario.goals[usize::from(goal.kind)];
            (kind.name.clone(), goal.index)
        };
        let old = before.goals.all.iter().enumerate();
        let old = old.map(|(number, goal)| (name(from, goal), number));
        let old: BTreeMap<(String, u32), usize> = old.collect();
        let mut numbers = BTreeMap::new();
        let mut all = std::mem::take(&mut self.goals).all;
        for (number, goal) in all.iter_mut().enumerate() {
            if let Some(was) = old.get(&name(to, goal)) {
                let kept = &before.goals.all[*was];
                (goal.id, goal.at) = (kept.id, kept.at);
                numbers.insert(*was, number);
            }
        }
        self.goals = Goals::new(all);
        numbers
    }
}

impl Scenario {
    /// The longest service lease of its controllers, in steps, as its grantor waits for its end.
    pub(super) fn longest_lease(&self) -> u64 {
        let kinds = self.controllers.iter().map(|kind| &kind.settings);
        let leases_s = kinds.map(|settings| wait_s(settings.service_lease_s, settings.max_drift));
        steps_of(leases_s.fold(0.0, f64::max), self.step_s) + 1
    }

    /// The controller that is first in turn to own a goal, and the number of controllers of its kind; `None` if no
    /// controllers own it, or there are none of any kind.
    pub(super) fn first_owner(&self, goal: &Goal) -> Option<(AgentId, u32)> {
        let owner = usize::from(self.goals[usize::from(goal.kind)].owner?);
        let count = self.controllers[owner].count;
        let has_others = self.controllers.iter().any(|kind| kind.count > 0);
        let index = goal.index.checked_rem(count).or(has_others.then_some(0))?;
        let kind = self.controller_number(owner);
        Some((AgentId::controller(kind, index), count))
    }
}

impl GoalTally {
    /// Takes over what happened before to goals by their new numbers, and to robots from their `old` numbers.
    fn take_over(
        &mut self,
        before: &Self,
        numbers: &BTreeMap<usize, usize>,
        old: &[Option<usize>],
        ids: &BTreeMap<AgentId, AgentId>,
    ) {
        self.messages_sent = before.messages_sent;
        self.messages_dropped = before.messages_dropped;
        let new_id = |id: AgentId| ids.get(&id).copied();
        for (was, now) in numbers {
            let record = &mut self.records[*now];
            *record = before.records[*was];
            // A controller with another id has restarted.
            record.issued_to = record.issued_to.filter(|id| new_id(*id) == Some(*id));
            if let Some(served) = &mut record.served {
                served.by = served.by.and_then(new_id);
            }
        }
        let robot = |was: usize| old.iter().position(|old| *old == Some(was));
        self.keep_stays(before, robot, |was| numbers.get(&was).copied());
        for (journey, was) in self.journeys.iter_mut().zip(old) {
            let kept = was.and_then(|was| before.journeys.get(was));
            let goal = kept.and_then(|kept| numbers.get(&kept.goal?));
            if let (Some(kept), Some(goal)) = (kept, goal) {
                *journey = kept.with_goal(*goal);
            }
        }
    }
}
