//! The interface of a behaviour.

use crate::goals::Verdict;
use crate::goals::proposal::Proposal;
use crate::io::command::Motion;
use crate::perception::situation::Situation;

/// A behaviour in a body.
pub(crate) trait Behaviour {
    /// What a robot remembers for it.
    type Memory: Clone;

    /// Whether it is of use only to a robot with a mind.
    const NEEDS_BELIEFS: bool = false;

    /// Whether it is of use only to a robot that has a position sensor and a compass, as a mind needs.
    const NEEDS_POSE: bool = Self::NEEDS_BELIEFS;

    /// Whether it is of use only to a robot that recognises items.
    const NEEDS_DETECTOR: bool = false;

    /// The memory of a robot that has just been switched on.
    fn memory(&self) -> Self::Memory;

    /// For so long it keeps control after it last had something to do.
    fn hold_s(&self) -> f64 {
        0.0
    }

    /// What it asks for, if it has something to do. It is asked at each step at which no higher
    /// behaviour has control.
    fn triggered(&self, memory: &mut Self::Memory, situation: &Situation) -> Option<Proposal>;

    /// It is told that it does not get where it wants to be.
    fn judged(&self, _memory: &mut Self::Memory, _verdict: Verdict) {}

    /// How it moves while it keeps control with nothing to do.
    fn held(&self) -> Motion;

    /// Instead of being asked, it is told that a higher behaviour has control.
    fn suppressed(&self, _memory: &mut Self::Memory) {}
}
