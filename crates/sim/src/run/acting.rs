//! What a robot with tools is doing with them.

use crate::bodies::kind::Kind;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Act, Acted, MAX_ACTS, Percept};

/// The acts of a robot with tools.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Acting {
    /// Acts of its last command that are not done yet.
    pub(crate) acts: Vec<Act>,
    /// The act that takes time and has begun.
    pub(crate) work: Option<Work>,
    /// Charges that are left; `None` without a tool that needs them.
    pub(crate) charges: Option<u32>,
    /// Results that its brain does not know yet.
    results: Vec<Acted>,
}

/// An act that has begun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Work {
    pub(crate) act: Act,
    /// The first step for which the robot was stationary.
    pub(crate) since: u64,
}

impl Acting {
    /// Of a robot of a kind at the start, if it has tools.
    pub(crate) fn new(kind: &Kind) -> Option<Box<Self>> {
        let charges = kind.charges;
        let acting = || Self {
            charges,
            ..Self::default()
        };
        (!kind.tools.is_empty()).then(|| Box::new(acting()))
    }

    /// Replaces the acts by those of a new command.
    pub(crate) fn command(&mut self, acts: &[Act]) {
        self.acts.clear();
        self.acts.extend(acts.iter().take(MAX_ACTS));
    }

    /// Notes the result of an act.
    pub(crate) fn report(&mut self, Act { kind, at }: Act, is_success: bool) {
        self.results.push(Acted {
            kind,
            at,
            is_success,
        });
    }

    /// Moves the results into a percept.
    pub(crate) fn deliver(&mut self, percept: &mut Percept) {
        percept.acted.append(&mut self.results);
        percept.charges = self.charges;
    }

    /// Takes over the memory of a robot that had the same tools, or others: no more charges than it had.
    pub(crate) fn take_over(&mut self, before: &Self) {
        let charges = self.charges.zip(before.charges);
        let charges = charges
            .map(|(now, before)| now.min(before))
            .or(self.charges);
        *self = Self {
            charges,
            ..before.clone()
        };
    }

    /// Adds everything observable to the hash of a run.
    pub(crate) fn add_to(&self, hash: &mut Hash) {
        self.acts.add_to(hash);
        self.work.map(|work| (work.act, work.since)).add_to(hash);
        self.charges.add_to(hash);
        self.results.add_to(hash);
    }
}
