//! What robots have done to items.

use super::events::{EventKind, EventLog};
use super::items::Detection;
use crate::bodies::Layer;
use crate::scenario::Scenario;
use crate::world::items::{Items, MARK_TOLERANCE_M};
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Act, ActKind, AgentId};
use std::collections::BTreeMap;

/// An act that was completed.
#[derive(Debug, Clone)]
pub(crate) struct Done {
    pub(crate) act: Act,
    pub(crate) by: AgentId,
    /// The numbers of the items that it concerns.
    pub(crate) items: Vec<u32>,
    pub(crate) is_success: bool,
}

/// What was done to the items of a run.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct ActTally {
    /// By the number of the item.
    items: BTreeMap<u32, ItemActs>,
    /// Marked places without a target.
    pub(super) false_marks: Vec<Point>,
    /// Confirmed places without a target.
    pub(super) false_confirmations: Vec<Point>,
    /// Robots that items destroyed.
    pub(super) robots_lost: u32,
    /// Charges that robots of each kind have used, by the key of the kind.
    charges: BTreeMap<u32, u64>,
}

/// What was done to one item.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ItemActs {
    /// The first act of each kind, in the order of [`ActKind`].
    firsts: [Option<Detection>; 5],
    /// Whether a flying robot has marked it.
    pub(super) is_marked_from_air: bool,
    /// Whether a robot on the ground has detected it or come too near to it.
    pub(super) is_met: bool,
}

impl ItemActs {
    /// The first act of a kind.
    pub(crate) fn first(&self, kind: ActKind) -> Option<Detection> {
        self.firsts[kind as usize]
    }

    fn renumbered(self, new_id: impl Fn(AgentId) -> Option<AgentId>) -> Self {
        let renumbered = |first: Detection| Detection {
            by: first.by.and_then(&new_id),
            ..first
        };
        Self {
            firsts: self.firsts.map(|first| first.map(renumbered)),
            ..self
        }
    }
}

impl ActTally {
    /// Notes an act; returns whether it counts: the first of its kind on an item, at a place without a target, or an
    /// attempt.
    pub(super) fn note(
        &mut self,
        done: &Done,
        (scenario, tick, items): (&Scenario, u64, &Items),
        events: &EventLog,
    ) -> bool {
        let is_target = |item: &u32| scenario.items[usize::from(items.kind(*item))].is_target;
        let is_from_air = scenario.kind_of(done.by).layer == Layer::Air;
        let is_mark_from_air = is_from_air && done.act.kind == ActKind::Mark;
        let mut is_counted = false;
        if done.act.kind == ActKind::Neutralise {
            let kind = scenario.kind_of(done.by).key;
            *self.charges.entry(kind).or_default() += 1;
        }
        if done.is_success {
            for item in &done.items {
                let acts = self.items.entry(*item).or_default();
                acts.is_marked_from_air |= is_mark_from_air;
                let first = &mut acts.firsts[done.act.kind as usize];
                is_counted |= first.is_none();
                let by = Some(done.by);
                first.get_or_insert(Detection { at: tick, by });
            }
        }
        let is_false = !done.items.iter().any(is_target);
        is_counted |= match done.act.kind {
            ActKind::Mark if is_false => is_new(&mut self.false_marks, done.act.at, scenario),
            ActKind::Confirm if is_false => {
                is_new(&mut self.false_confirmations, done.act.at, scenario)
            }
            // Controllers state the last two, without a place.
            ActKind::Mark | ActKind::Confirm | ActKind::DeclareClear | ActKind::GiveUp => false,
            ActKind::Reject | ActKind::Isolate => done.items.is_empty(),
            ActKind::Neutralise => true,
        };
        if is_counted {
            events.note(tick, event(done, items));
        }
        is_counted
    }

    /// Charges that robots of a kind have used, by the key of the kind.
    pub(super) fn charges_of(&self, kind: u32) -> u64 {
        self.charges.get(&kind).copied().unwrap_or_default()
    }

    /// Notes that a robot on the ground has detected an item or come too near to it.
    pub(super) fn meet(&mut self, item: u32) {
        self.items.entry(item).or_default().is_met = true;
    }

    /// What was done to an item.
    pub(super) fn of(&self, item: u32) -> ItemActs {
        self.items.get(&item).copied().unwrap_or_default()
    }

    /// The tally of the run as it continues: of each item that stays, `kept` has its number there and here.
    pub(super) fn continued(
        &self,
        kept: &[(usize, usize)],
        new_id: impl Fn(AgentId) -> Option<AgentId>,
    ) -> Self {
        let of = |(now, was): &(usize, usize)| {
            let [now, was] = [now, was].map(|number| u32::try_from(*number).ok());
            let acts = self.items.get(&was?)?;
            Some((now?, acts.renumbered(&new_id)))
        };
        Self {
            items: kept.iter().filter_map(of).collect(),
            ..self.clone()
        }
    }

    /// Adds everything observable to the hash of a run.
    pub(super) fn add_to(&self, hash: &mut Hash) {
        for (item, acts) in &self.items {
            item.add_to(hash);
            let firsts = acts.firsts.map(|first| first.map(|first| first.at));
            firsts.add_to(hash);
            acts.is_marked_from_air.add_to(hash);
            acts.is_met.add_to(hash);
        }
        self.false_marks.add_to(hash);
        self.false_confirmations.add_to(hash);
        self.robots_lost.add_to(hash);
    }
}

/// Adds a place, unless it is one of the places already.
fn is_new(places: &mut Vec<Point>, at: Point, scenario: &Scenario) -> bool {
    let is_known = |place: &Point| at.to(scenario.image(at, *place)).length() <= MARK_TOLERANCE_M;
    let is_new = !places.iter().any(is_known);
    if is_new {
        places.push(at);
    }
    is_new
}

fn event(done: &Done, items: &Items) -> EventKind {
    let item = done.items.first();
    EventKind::Acted {
        act: done.act.kind,
        by: done.by,
        at: done.act.at,
        item: item.map(|item| (items.kind(*item), items.thing(*item).index)),
        is_success: done.is_success,
    }
}
