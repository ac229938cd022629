//! What is counted during a run.

use super::cost::Cost;
use super::detections::Detections;
use super::goal_tally::GoalTally;
use crate::bodies::body_state::BodyState;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::hash::Hash;
use base::hashed::Hashed;

/// Counts of a run, besides those of each robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Tally {
    /// The step in which each item was found, by its number.
    found_at: Vec<Option<u64>>,
    /// Items found, by kind.
    pub(super) found: Vec<u32>,
    /// The step in which the run was complete.
    pub(crate) complete_at: Option<u64>,
    pub(super) false_alarms: u64,
    pub(super) collisions: u64,
    /// The cost of robots that were removed.
    pub(super) removed: Cost,
    /// Counts of goals, in a scenario with kinds of goals.
    pub(crate) goals: Option<Box<GoalTally>>,
}

impl Tally {
    /// The tally of a run that begins.
    pub(crate) fn new(scenario: &Scenario, items: &Items) -> Self {
        Self {
            found_at: vec![None; items.len()],
            found: vec![0; scenario.items.len()],
            goals: scenario.goals().map(Box::new),
            ..Self::default()
        }
    }

    /// Notes what robots detected in step `tick`; returns whether any of it counts. An item is found when it is
    /// first detected.
    pub(crate) fn detected(&mut self, detections: &Detections, tick: u64, items: &Items) -> bool {
        self.false_alarms += detections.false_alarms;
        let mut is_counted = detections.false_alarms > 0;
        for item in &detections.sightings {
            let found_at = &mut self.found_at[*item as usize];
            if found_at.is_none() {
                *found_at = Some(tick);
                self.found[usize::from(items.kind(*item))] += 1;
                is_counted = true;
            }
        }
        is_counted
    }

    /// Notes new contacts of bodies; returns whether there are any.
    pub(crate) fn collided(&mut self, collisions: u64) -> bool {
        self.collisions += collisions;
        collisions > 0
    }

    /// Items found, and everything else that is counted besides the robots that stopped.
    pub(crate) fn counts(&self) -> (u64, u64) {
        let found = self.found.iter().copied().map(u64::from).sum();
        let others = self.false_alarms + self.collisions + u64::from(self.removed.stopped);
        let goals = self.goals.as_deref();
        let served = goals.map_or(0, |goals| {
            u64::from(goals.served()) + goals.served_twice() as u64
        });
        (
            found,
            others + served + u64::from(self.complete_at.is_some()),
        )
    }

    /// The step in which each item was found, by its number.
    pub(crate) fn found_at(&self) -> impl Iterator<Item = Option<u64>> {
        self.found_at.iter().copied()
    }

    /// The tally of the run as it continues with the items of another scenario and without the robots that are
    /// `removed`. Of each item that stays, `kept` has its number there and here. Whether the run is complete is not noted.
    pub(crate) fn continued(
        &self,
        (scenario, items): (&Scenario, &Items),
        kept: &[(usize, usize)],
        removed: &[BodyState],
    ) -> Self {
        let mut next = Self {
            removed: self.removed.and(removed.iter()),
            ..Self::new(scenario, items)
        };
        (next.false_alarms, next.collisions) = (self.false_alarms, self.collisions);
        for (now, was) in kept {
            next.found_at[*now] = self.found_at[*was];
        }
        for (kind, found_at) in items.kinds().zip(&next.found_at) {
            next.found[usize::from(kind)] += u32::from(found_at.is_some());
        }
        next
    }

    /// Adds everything observable to the hash of a run.
    pub(crate) fn add_to(&self, hash: &mut Hash, items: &Items) {
        for (kind, found_at) in items.kinds().zip(&self.found_at) {
            hash.add(u64::from(kind) << 48 | found_at.map_or(0, |tick| tick + 1));
        }
        hash.add(self.false_alarms);
        hash.add(self.collisions);
        if let Some(goals) = &self.goals {
            goals.as_ref().add_to(hash);
        }
        if self.removed != Cost::default() {
            hash.add(self.removed.energy_j.to_bits());
            hash.add(self.removed.distance_m.to_bits());
            hash.add(self.removed.stopped.into());
        }
    }
}
