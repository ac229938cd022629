//! What is counted during a run.

use super::cost::Cost;
use super::detections::Detections;
use crate::bodies::body_state::BodyState;
use crate::scenario::Scenario;
use crate::world::items::Items;
use base::hash::Hash;

/// Counts of a run, besides those of each robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Tally {
    /// The step in which each item was found, by its number.
    found_at: Vec<Option<u64>>,
    /// Targets that are not found.
    targets_left: u32,
    /// The step in which the last target was found.
    pub(super) complete_at: Option<u64>,
    pub(super) false_alarms: u64,
    pub(super) collisions: u64,
    /// The cost of robots that were removed.
    pub(super) removed: Cost,
}

impl Tally {
    /// The tally of a run that begins.
    pub(crate) fn new(scenario: &Scenario, items: &Items) -> Self {
        let mut tally = Self {
            found_at: vec![None; items.len()],
            ..Self::default()
        };
        tally.count_targets(scenario, items);
        tally
    }

    /// Notes what robots detected in step `tick`. An item is found when it is first detected.
    pub(crate) fn detected(
        &mut self,
        detections: &Detections,
        tick: u64,
        is_target: impl Fn(u32) -> bool,
    ) {
        self.false_alarms += detections.false_alarms;
        for item in &detections.sightings {
            let found_at = &mut self.found_at[*item as usize];
            if found_at.is_none() {
                *found_at = Some(tick);
                self.found(tick, is_target(*item));
            }
        }
    }

    fn found(&mut self, tick: u64, is_target: bool) {
        self.targets_left -= u32::from(is_target);
        if is_target && self.targets_left == 0 {
            self.complete_at = Some(tick);
        }
    }

    /// Notes new contacts of bodies.
    pub(crate) fn collided(&mut self, collisions: u64) {
        self.collisions += collisions;
    }

    /// The step in which each item was found, by its number.
    pub(crate) fn found_at(&self) -> impl Iterator<Item = Option<u64>> {
        self.found_at.iter().copied()
    }

    /// The tally of the run as it continues with the items of another scenario and without the robots that are
    /// `removed`. Of each item that stays, `kept` has its number there and here.
    pub(crate) fn continued(
        &self,
        (scenario, items): (&Scenario, &Items),
        kept: &[(usize, usize)],
        removed: &[BodyState],
    ) -> Self {
        let mut next = Self {
            found_at: vec![None; items.len()],
            removed: self.removed.and(removed.iter()),
            ..*self
        };
        for (now, was) in kept {
            next.found_at[*now] = self.found_at[*was];
        }
        next.count_targets(scenario, items);
        next
    }

    /// Counts the targets that are left. Removing targets can complete a run, and adding some can reopen it.
    fn count_targets(&mut self, scenario: &Scenario, items: &Items) {
        let found = items.kinds().zip(self.found_at());
        let targets = found.filter(|(kind, _)| scenario.items[usize::from(*kind)].is_target);
        let found: Vec<Option<u64>> = targets.map(|(_, found_at)| found_at).collect();
        let left = found.iter().filter(|found_at| found_at.is_none()).count();
        self.targets_left = u32::try_from(left).unwrap_or(u32::MAX);
        let last = found.into_iter().flatten().max();
        self.complete_at = last.filter(|_| left == 0);
    }

    /// Adds everything observable to the hash of a run.
    pub(crate) fn add_to(&self, hash: &mut Hash, items: &Items) {
        for (kind, found_at) in items.kinds().zip(&self.found_at) {
            hash.add(u64::from(kind) << 48 | found_at.map_or(0, |tick| tick + 1));
        }
        hash.add(self.false_alarms);
        hash.add(self.collisions);
        if self.removed != Cost::default() {
            hash.add(self.removed.energy_j.to_bits());
            hash.add(self.removed.distance_m.to_bits());
            hash.add(self.removed.stopped.into());
        }
    }
}
