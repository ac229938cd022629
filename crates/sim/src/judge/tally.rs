//! What is counted during a run.

use super::act_tally::{ActTally, Done};
use super::clearance_tally::ClearanceTally;
use super::conclusion_tally::ConclusionTally;
use super::cost::Cost;
use super::detections::{Detections, Sighting};
use super::events::{EventKind, EventLog};
use super::goal_tally::GoalTally;
use super::items::{Detection, ItemRecord};
use crate::bodies::Layer;
use crate::bodies::body_state::BodyState;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::AgentId;
use std::collections::BTreeMap;
use std::iter;

/// Counts of a run, besides those of each robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Tally {
    /// By the number of the item.
    records: Vec<ItemRecord>,
    /// Items of the run, by kind.
    present: Vec<u32>,
    /// Looks after which an item counts as detected, by kind.
    confirm_looks: Vec<u32>,
    /// Items found, by kind.
    pub(super) found: Vec<u32>,
    /// The step in which the run was complete.
    pub(crate) complete_at: Option<u64>,
    /// Steps in which anything was counted.
    pub(crate) counted_steps: u64,
    pub(super) false_alarms: u64,
    pub(super) collisions: u64,
    /// The cost of robots that were removed.
    pub(super) removed: Cost,
    /// The same of each kind of robots, by the key of the kind.
    pub(super) removed_of: BTreeMap<u32, Cost>,
    /// Counts of goals, in a scenario with kinds of goals.
    pub(crate) goals: Option<Box<GoalTally>>,
    /// What was done to items, in a scenario where anything can be.
    pub(crate) acts: Option<Box<ActTally>>,
    /// What was noted of a lane, in a scenario where controllers are to clear one.
    pub(crate) clearance: Option<Box<ClearanceTally>>,
    /// What controllers stated of that lane beside the risk.
    pub(crate) conclusion: Option<Box<ConclusionTally>>,
}

impl Tally {
    /// The tally of a run that begins.
    pub(crate) fn new(scenario: &Scenario, items: &Items) -> Self {
        let mut present = vec![0; scenario.items.len()];
        items
            .kinds()
            .for_each(|kind| present[usize::from(kind)] += 1);
        Self {
            records: vec![ItemRecord::default(); items.len()],
            present,
            found: vec![0; scenario.items.len()],
            confirm_looks: scenario
                .items
                .iter()
                .map(|kind| kind.confirm_looks)
                .collect(),
            goals: scenario.goals().map(Box::new),
            acts: scenario.has_acts.then(Box::default),
            clearance: scenario
                .clearance()
                .map(|_| Box::new(ClearanceTally::new(scenario))),
            ..Self::default()
        }
    }

    /// Notes what robots detected in a step; returns whether any of it counts. An item is found when it
    /// counts as detected: after the looks that its kind needs.
    pub(crate) fn detected(
        &mut self,
        detections: &Detections,
        (tick, items, ids): (u64, &Items, &[AgentId]),
        events: &EventLog,
    ) -> bool {
        self.false_alarms += detections.false_alarms;
        let mut is_counted = detections.false_alarms > 0;
        for sighting in &detections.sightings {
            let record = &mut self.records[sighting.item as usize];
            if record.detected.is_some() {
                continue;
            }
            let (by, kind) = (ids[sighting.robot as usize], items.kind(sighting.item));
            if record.looks + 1 < self.confirm_looks[usize::from(kind)] {
                record.looks += 1;
                continue;
            }
            let at = tick;
            record.detected = Some(Detection { at, by: Some(by) });
            self.found[usize::from(kind)] += 1;
            is_counted = true;
            let item = (kind, items.thing(sighting.item).index);
            events.note(tick, EventKind::Detected { item, by });
        }
        is_counted
    }

    /// Notes an act of a robot; returns whether it counts.
    pub(crate) fn acted(
        &mut self,
        done: &Done,
        now: (&Scenario, u64, &Items),
        events: &EventLog,
    ) -> bool {
        let acts = self.acts.as_mut();
        acts.is_some_and(|acts| acts.note(done, now, events))
    }

    /// Notes the items that robots on the ground have detected, in a scenario where anything can happen to items.
    pub(crate) fn ground_detected(
        &mut self,
        detections: &Detections,
        (scenario, ids): (&Scenario, &[AgentId]),
    ) {
        let Some(acts) = &mut self.acts else {
            return;
        };
        for Sighting { robot, item } in &detections.sightings {
            let kind = scenario.kind_of(ids[*robot as usize]);
            if kind.layer == Layer::Ground {
                acts.meet(*item);
            }
        }
    }

    /// Notes that a robot on the ground came too near to an item.
    pub(crate) fn met(&mut self, item: u32) {
        if let Some(acts) = &mut self.acts {
            acts.meet(item);
        }
    }

    /// Notes that an item has destroyed a robot.
    pub(crate) fn lost(
        &mut self,
        (robot, item): (AgentId, u32),
        (tick, items): (u64, &Items),
        events: &EventLog,
    ) {
        if let Some(acts) = &mut self.acts {
            acts.robots_lost += 1;
        }
        let item = (items.kind(item), items.thing(item).index);
        events.note(tick, EventKind::Destroyed { robot, item });
    }

    /// Whether an item was detected.
    pub(super) fn is_detected(&self, item: u32) -> bool {
        self.records[item as usize].detected.is_some()
    }

    /// Notes messages that were dropped, because a participant could not send or receive that many in a step.
    pub(crate) fn dropped(&mut self, messages: u64) {
        if let Some(goals) = &mut self.goals {
            goals.messages_dropped += messages;
        }
        if let Some(clearance) = &mut self.clearance {
            clearance.messages_dropped += messages;
        }
    }

    /// Notes new contacts of bodies; returns whether there are any.
    pub(crate) fn collided(&mut self, collisions: u64) -> bool {
        self.collisions += collisions;
        collisions > 0
    }

    /// Items found, and a number that is higher when anything else was counted since, besides the robots that stopped.
    pub(crate) fn counts(&self) -> (u64, u64) {
        let found = self.found.iter().copied().map(u64::from).sum();
        (found, self.counted_steps + u64::from(self.removed.stopped))
    }

    /// Items of a kind that are not found.
    pub(super) fn missed(&self, kind: usize) -> u32 {
        self.present[kind] - self.found[kind]
    }

    /// What happened to each item, by its number.
    pub(crate) fn records(&self) -> impl Iterator<Item = &ItemRecord> {
        self.records.iter()
    }

    /// The tally of the run as it continues with the items of another scenario and without the robots that are
    /// `removed`, each with the key of its kind. Of each item that stays, `kept` has its number there and here, and of each robot, `ids` has its id here
    /// and there. Whether the run is complete is not noted.
    pub(crate) fn continued(
        &self,
        (scenario, items): (&Scenario, &Items),
        kept: &[(usize, usize)],
        (removed, ids): (&[(u32, BodyState)], &BTreeMap<AgentId, AgentId>),
    ) -> Self {
        let mut next = Self {
            removed: self.removed.and(removed.iter().map(|(_, state)| state)),
            removed_of: self.removed_of.clone(),
            ..Self::new(scenario, items)
        };
        for (kind, state) in removed {
            let cost = next.removed_of.entry(*kind).or_default();
            *cost = cost.and(iter::once(state));
        }
        next.counted_steps = self.counted_steps;
        (next.false_alarms, next.collisions) = (self.false_alarms, self.collisions);
        for (now, was) in kept {
            next.records[*now] = self.records[*was].renumbered(|id| ids.get(&id).copied());
        }
        if let Some((next, before)) = next.acts.as_mut().zip(self.acts.as_ref()) {
            **next = before.continued(kept, |id| ids.get(&id).copied());
        }
        if let Some((next, before)) = next.clearance.as_mut().zip(self.clearance.as_ref()) {
            **next = before.continued(scenario);
        }
        next.conclusion.clone_from(&self.conclusion);
        for (kind, record) in items.kinds().zip(&next.records) {
            next.found[usize::from(kind)] += u32::from(record.detected.is_some());
        }
        next
    }

    /// Adds everything observable to the hash of a run.
    pub(crate) fn add_to(&self, hash: &mut Hash, items: &Items) {
        for (kind, record) in items.kinds().zip(&self.records) {
            record.add_to(kind, hash);
        }
        hash.add(self.false_alarms);
        hash.add(self.collisions);
        if let Some(goals) = &self.goals {
            goals.as_ref().add_to(hash);
        }
        if let Some(acts) = &self.acts {
            acts.add_to(hash);
        }
        if let Some(clearance) = &self.clearance {
            clearance.add_to(hash);
        }
        if let Some(conclusion) = &self.conclusion {
            conclusion.as_ref().add_to(hash);
        }
        if self.removed != Cost::default() {
            hash.add(self.removed.energy_j.to_bits());
            hash.add(self.removed.distance_m.to_bits());
            hash.add(self.removed.stopped.into());
        }
    }
}
