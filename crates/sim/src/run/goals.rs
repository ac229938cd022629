//! Goals are issued when they arrive, and stay when a run continues with another scenario.

use super::state::State;
use crate::goals::placed::{Goal, Goals};
use crate::judge::goal_tally::GoalTally;
use crate::scenario::Scenario;
use brain::{About, Dispatch, Message, ReceivedMessage, RobotId};
use std::collections::BTreeMap;

impl State {
    /// Issues the goals that arrive in this step, or that have lost their controller.
    pub(crate) fn issue_goals(&mut self, scenario: &Scenario) {
        while let Some(number) = self.goals.next_arrival(self.tick) {
            self.issue(scenario, number);
        }
    }

    fn issue(&mut self, scenario: &Scenario, number: usize) {
        let Some(tally) = &mut self.tally.goals else {
            return;
        };
        let (goal, record) = (&self.goals.all[number], &mut tally.records[number]);
        record.issued_at.get_or_insert(self.tick);
        let kind = &scenario.goals[usize::from(goal.kind)];
        let Some(owner) = scenario.owner_of(goal) else {
            return;
        };
        let place = self
            .controllers
            .binary_search_by_key(&owner, |agent| agent.participant.id);
        if let Ok(place) = place {
            let task = kind.task(goal.id, goal.at);
            let order = ReceivedMessage {
                from: RobotId::OPERATOR,
                age_s: 0.0,
                message: Message::to(owner, About::Dispatch(Dispatch::Issue(task))),
            };
            record.issued_to = Some(owner);
            let participant = &mut self.controllers[place].participant;
            participant.receive_order(order, self.tick);
        }
    }

    /// Takes over the goals that stay, and the journeys of robots from their `old` numbers.
    pub(super) fn keep_goals(
        &mut self,
        (before, from): (&Self, &Scenario),
        to: &Scenario,
        old: &[Option<usize>],
        ids: &BTreeMap<RobotId, RobotId>,
    ) {
        let Some(mut tally) = self.tally.goals.take() else {
            return;
        };
        if let Some(was) = &before.tally.goals {
            let numbers = self.keep_places((before, from), to);
            tally.take_over(was, &numbers, old, ids);
        }
        let waits = |(number, goal): &(usize, &Goal)| {
            let record = &tally.records[*number];
            let is_lost = record.issued_to.is_none() && to.owner_of(goal).is_some();
            record.issued_at.is_none() || record.served.is_none() && is_lost
        };
        let waiting = self.goals.all.iter().enumerate().filter(waits);
        let waiting = waiting.map(|(number, _)| number).collect();
        self.goals.wait(waiting);
        self.tally.goals = Some(tally);
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
    /// The controller that a goal is issued to; `None` if there are none of the kind that owns it.
    fn owner_of(&self, goal: &Goal) -> Option<RobotId> {
        let owner = usize::from(self.goals[usize::from(goal.kind)].owner?);
        let count = self.controllers[owner].count;
        (count > 0).then(|| RobotId {
            kind: self.controller_number(owner),
            index: goal.index % count,
        })
    }
}

impl GoalTally {
    /// Takes over what happened before to goals by their new numbers, and to robots from their `old` numbers.
    fn take_over(
        &mut self,
        before: &Self,
        numbers: &BTreeMap<usize, usize>,
        old: &[Option<usize>],
        ids: &BTreeMap<RobotId, RobotId>,
    ) {
        self.messages_sent = before.messages_sent;
        self.messages_dropped = before.messages_dropped;
        let new_id = |id: RobotId| ids.get(&id).copied();
        for (was, now) in numbers {
            let record = &mut self.records[*now];
            *record = before.records[*was];
            // A controller with another id has restarted.
            record.issued_to = record.issued_to.filter(|id| new_id(*id) == Some(*id));
            if let Some(served) = &mut record.served {
                served.by = served.by.and_then(new_id);
            }
        }
        for (journey, was) in self.journeys.iter_mut().zip(old) {
            let kept = was.and_then(|was| before.journeys.get(was));
            let goal = kept.and_then(|kept| numbers.get(&kept.goal?));
            if let (Some(kept), Some(goal)) = (kept, goal) {
                *journey = kept.with_goal(*goal);
            }
        }
    }
}
