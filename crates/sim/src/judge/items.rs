//! What happened to each item of a run.

use base::hash::Hash;
use brain::AgentId;

/// What happened to one item so far. Another thing that can happen to items is a field here, with its
/// part of [`ItemRecord::add_to`] and, if it names robots, of [`ItemRecord::renumbered`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ItemRecord {
    /// The look at which it counted as detected.
    pub(crate) detected: Option<Detection>,
    /// Looks with a contact before that.
    pub(crate) looks: u32,
}

/// A detection of an item.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Detection {
    /// The step in which it was reported.
    pub(crate) at: u64,
    /// The robot; `None` if it was removed.
    pub(crate) by: Option<AgentId>,
}

impl ItemRecord {
    /// The step in which the item was found: it counted as detected.
    pub(crate) fn found_at(&self) -> Option<u64> {
        self.detected.map(|detection| detection.at)
    }

    /// The record in a run whose robots have other ids; `None` for those that were removed.
    pub(super) fn renumbered(self, new_id: impl Fn(AgentId) -> Option<AgentId>) -> Self {
        let detected = self.detected.map(|detection| Detection {
            by: detection.by.and_then(new_id),
            ..detection
        });
        Self { detected, ..self }
    }

    /// Adds what happened to an item of a kind to the hash of a run. What a scenario does not use adds nothing.
    pub(super) fn add_to(&self, kind: u16, hash: &mut Hash) {
        hash.add(u64::from(kind) << 48 | self.found_at().map_or(0, |tick| tick + 1));
        if self.looks > 0 {
            hash.add(self.looks.into());
        }
    }
}
