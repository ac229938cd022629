//! What was noted of a lane that controllers are to clear.

use crate::scenario::Scenario;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{About, ContractMessage, GoalId, Message, Receiver};
use std::collections::BTreeMap;

/// How far a controller has come with the lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    /// Its index.
    pub(crate) controller: usize,
    /// Whether it has declared the lane clear, once it has stated anything.
    pub(crate) is_clear: Option<bool>,
    /// The risk that it has stated; none if the decision was made elsewhere.
    pub(crate) risk: Option<f64>,
    /// Whether a mark that may be a mine has no verdict.
    pub(crate) has_open_marks: bool,
    /// Whether a person has ended its mission.
    pub(crate) is_called_off: bool,
}

/// The mines that are left in the lane, and what a controller believes of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Remains {
    pub(crate) mines: u32,
    /// The part of them that is at the controller's marks.
    pub(crate) at_marks: f64,
    /// Numbers of mines that the controller expects without a mark, and at marks.
    pub(crate) believed_unmarked: f64,
    pub(crate) believed_marked: f64,
}

/// The first declaration that the lane is clear, or the last of the controllers that gave it up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stated {
    /// The step.
    pub(super) at: u64,
    pub(super) is_clear: bool,
    /// The risk that the controller stated; 1 if it stated none.
    pub(super) risk: f64,
    /// What was left then.
    pub(super) remains: Remains,
    /// Whether a person had ended the mission.
    pub(super) is_called_off: bool,
}

/// What was noted of a lane.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct ClearanceTally {
    pub(super) stated: Option<Stated>,
    /// Whether no controller with the lane works any more.
    pub(super) has_lost_controllers: bool,
    /// Since which step no mark waits for a verdict.
    pub(super) interrogated_at: Option<u64>,
    /// Steps in which robots of each kind were active, summed over its robots.
    pub(super) on_station: Vec<u64>,
    pub(super) messages_sent: u64,
    pub(super) messages_dropped: u64,
    pub(super) awards: u64,
    /// Awards of a goal to another robot than before.
    pub(super) reallocations: u64,
    /// The robot to which each goal was last awarded.
    awarded: BTreeMap<GoalId, Receiver>,
}

impl ClearanceTally {
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self {
            on_station: vec![0; scenario.kinds.len()],
            ..Self::default()
        }
    }

    /// Whether a controller has declared the lane clear.
    pub(super) fn has_declared(&self) -> bool {
        self.stated.is_some_and(|stated| stated.is_clear)
    }

    /// Whether all controllers have given it up.
    pub(super) fn has_given_up(&self) -> bool {
        self.stated.is_some_and(|stated| !stated.is_clear)
    }

    /// Whether they gave it up as a person ended the mission.
    pub(super) fn is_called_off(&self) -> bool {
        self.stated.is_some_and(|stated| stated.is_called_off)
    }

    /// Notes a message that a participant sends.
    pub(crate) fn sent(&mut self, message: &Message) {
        self.messages_sent += 1;
        if let About::Contract(ContractMessage::Award(award)) = message.about {
            self.awards += 1;
            let before = self.awarded.insert(award.goal, message.to);
            self.reallocations += u64::from(before.is_some_and(|before| before != message.to));
        }
    }

    /// Notes that a robot of a kind is active in a step.
    pub(crate) fn on_station(&mut self, kind: u8) {
        if let Some(steps) = self.on_station.get_mut(usize::from(kind)) {
            *steps += 1;
        }
    }

    /// Notes how far the controllers that work have come; returns whether they have stated something. The lane is
    /// declared clear by the first of them that declares it, and given up when all have given it up.
    pub(crate) fn observe(
        &mut self,
        tick: u64,
        controllers: impl Iterator<Item = Progress>,
        remains: impl Fn(usize) -> Remains,
    ) -> bool {
        let (mut has_open_marks, mut is_undecided) = (false, false);
        let mut is_called_off = false;
        self.has_lost_controllers = true;
        let mut last: Option<(bool, f64, usize)> = None;
        for controller in controllers {
            self.has_lost_controllers = false;
            is_called_off |= controller.is_called_off;
            has_open_marks |= controller.has_open_marks;
            is_undecided |= controller.is_clear.is_none();
            let is_declared = last.is_some_and(|(is_clear, ..)| is_clear);
            let stated = controller.is_clear.filter(|_| !is_declared);
            let stated = stated.map(|is_clear| {
                let risk = controller.risk.unwrap_or(1.0);
                (is_clear, risk, controller.controller)
            });
            last = stated.or(last);
        }
        self.interrogated_at = if has_open_marks {
            None
        } else {
            self.interrogated_at.or(Some(tick))
        };
        let stated = last.filter(|(is_clear, ..)| *is_clear || !is_undecided);
        let Some((is_clear, risk, controller)) = stated.filter(|_| self.stated.is_none()) else {
            return false;
        };
        self.stated = Some(Stated {
            at: tick,
            is_clear,
            risk,
            remains: remains(controller),
            is_called_off: is_called_off && !is_clear,
        });
        true
    }

    /// The tally of the run as it continues with another scenario.
    pub(super) fn continued(&self, scenario: &Scenario) -> Self {
        let mut next = self.clone();
        next.on_station.resize(scenario.kinds.len(), 0);
        // There may be others now.
        next.has_lost_controllers = false;
        next
    }

    /// Adds everything observable to the hash of a run.
    pub(super) fn add_to(&self, hash: &mut Hash) {
        let stated = self.stated.map(|stated| (stated.at, stated.risk.to_bits()));
        stated.add_to(hash);
        self.interrogated_at.add_to(hash);
        self.on_station.add_to(hash);
        for count in [
            self.messages_sent,
            self.messages_dropped,
            self.awards,
            self.reallocations,
        ] {
            hash.add(count);
        }
    }
}
