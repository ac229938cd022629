//! Going on with another scenario in the middle of a run.

use super::mind::Mind;
use super::state::{NoRoom, State, draws, entity};
use crate::body::kind::Kind;
use crate::scenario::Scenario;
use base::placement::{NoPlaceFor, Things};
use std::collections::BTreeMap;

impl State {
    /// The run as it goes on with another scenario of the same step.
    ///
    /// Robots and items that are in both, by the names of their kinds and their indices, stay as
    /// they are; others come in where they would start, or go. A robot whose brain, body or sensors
    /// are now others begins with a new mind. Messages on their way are lost if the team changes.
    ///
    /// # Errors
    /// If there is no room for what comes in.
    pub fn changed(&self, from: &Scenario, to: &Scenario) -> Result<Self, NoRoom> {
        let mut next = Self::new(to, self.seed, self.run)?;
        next.tick = self.tick;
        let is_new = next.keep_robots(self, from, to);
        next.make_room(to, &is_new)?;
        next.keep_items(self, from, to);
        next.tally = self.tally;
        next.count_sought(to);
        if next.ids == self.ids {
            next.air = self.air.clone();
        }
        Ok(next)
    }

    /// Takes over robots that were there; returns for each robot whether it was not.
    fn keep_robots(&mut self, before: &Self, from: &Scenario, to: &Scenario) -> Vec<bool> {
        let old = before.ids.iter().enumerate();
        let old = old.map(|(robot, id)| ((from.name_of(*id), id.index), robot));
        let old: BTreeMap<(&str, u32), usize> = old.collect();
        let mut is_new = vec![false; self.robots()];
        for robot in 0..self.robots() {
            let id = self.ids[robot];
            let Some(&was) = old.get(&(to.name_of(id), id.index)) else {
                is_new[robot] = true;
                continue;
            };
            self.discs[robot].centre = before.discs[was].centre;
            self.courses[robot] = before.courses[was];
            self.hulls[robot] = before.hulls[was];
            let old_kind = &from.kinds[usize::from(before.ids[was].kind)];
            let kind = &to.kinds[usize::from(id.kind)];
            self.minds[robot] = kept_mind(&before.minds[was], old_kind, kind);
        }
        is_new
    }

    /// Puts robots that are new elsewhere where somebody is in their place by now.
    fn make_room(&mut self, scenario: &Scenario, is_new: &[bool]) -> Result<(), NoRoom> {
        let draws = draws(scenario, self.seed, self.run, Things::Robots);
        for robot in (0..self.robots()).filter(|robot| is_new[*robot]) {
            let (id, radius_m) = (self.ids[robot], self.discs[robot].radius_m);
            let kind = &scenario.kinds[usize::from(id.kind)];
            let is_alone = |place| {
                let others = self.discs.iter().zip(&self.ids).enumerate();
                let mut others = others.filter(|(other, (_, id))| {
                    *other != robot && scenario.kinds[usize::from(id.kind)].layer == kind.layer
                });
                others.all(|(_, (disc, _))| disc.distance_m(place) >= radius_m)
            };
            if !is_alone(self.discs[robot].centre) {
                let is_free =
                    |place| scenario.is_free(place, radius_m, kind.layer) && is_alone(place);
                let place = kind.start.place(&draws, entity(id), is_free);
                self.discs[robot].centre = place.map_err(|why| NoPlaceFor {
                    kind: id.kind,
                    index: id.index,
                    why,
                })?;
            }
        }
        Ok(())
    }

    fn keep_items(&mut self, before: &Self, from: &Scenario, to: &Scenario) {
        let old = before.items.named(from);
        let old: BTreeMap<_, _> = old.collect();
        let kept = self
            .items
            .named(to)
            .map(|(name, item)| (item.number, old.get(&name)));
        let kept: Vec<_> = kept
            .filter_map(|(number, item)| Some((number, *item?)))
            .collect();
        self.items.keep(&kept);
    }

    /// Counts the sought items that are left.
    fn count_sought(&mut self, scenario: &Scenario) {
        let is_left = |(kind, found): &(u16, Option<u64>)| {
            scenario.items[usize::from(*kind)].is_sought && found.is_none()
        };
        let left = self.items.each().filter(is_left).count();
        self.tally.sought_left = u32::try_from(left).unwrap_or(u32::MAX);
        if left > 0 {
            self.tally.complete_at = None;
        }
    }
}

fn kept_mind(mind: &Mind, from: &Kind, to: &Kind) -> Mind {
    let is_same = from.brain == to.brain && from.body == to.body && from.sensors == to.sensors;
    if is_same && from.needs_backlog() == to.needs_backlog() {
        mind.clone()
    } else {
        Mind::new(to)
    }
}
