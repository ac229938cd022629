//! The interface of a behaviour.

use crate::goals::Verdict;
use crate::goals::orders::AssignedGoal;
use crate::goals::proposal::Proposal;
use crate::io::agent_id::AgentId;
use crate::io::command::{Command, Motion};
use crate::service::assignee::Assignee;
use crate::situation::Situation;
use alloc::vec::Vec;

/// A behaviour in a body.
pub(crate) trait Behaviour {
    /// The state that each robot keeps for this behaviour.
    type Memory: Clone;

    /// Whether it requires beliefs.
    const NEEDS_BELIEFS: bool = false;

    /// Whether it requires a position sensor and a compass, as beliefs do.
    const NEEDS_POSE: bool = Self::NEEDS_BELIEFS;

    /// Whether it requires an item detector.
    const NEEDS_DETECTOR: bool = false;

    /// Whether it takes a person's orders.
    const TAKES_ORDERS: bool = false;

    /// Whether it serves the goals of controllers.
    const SERVES_CONTROLLERS: bool = false;

    /// The initial memory.
    fn memory(&self) -> Self::Memory;

    /// Time for which it stays active after its trigger has ended, in seconds.
    fn hold_s(&self) -> f64 {
        0.0
    }

    /// Takes a person's orders from the messages, and judges assigned goals. Called first in each
    /// step if it is the highest behaviour that takes orders.
    fn serve_orders(&self, _memory: &mut Self::Memory, _situation: &Situation) {}

    /// The goals that a person has assigned.
    fn assigned_goals(&self, _memory: &Self::Memory) -> Vec<AssignedGoal> {
        Vec::new()
    }

    /// Takes the messages of controllers. Called first in each step if it is the highest behaviour that
    /// serves them.
    fn communicate(&self, _memory: &mut Self::Memory, _situation: &Situation) {}

    /// Adds its messages to controllers, and its acts, to a command.
    fn publish(&self, _memory: &mut Self::Memory, _command: &mut Command) {}

    /// The goals of controllers that it serves.
    fn assignee<'m>(&self, _memory: &'m Self::Memory) -> Option<&'m Assignee> {
        None
    }

    /// Changes the ids of other agents; those without a new id are forgotten.
    fn renumber(&self, _memory: &mut Self::Memory, _new_id: &dyn Fn(AgentId) -> Option<AgentId>) {}

    /// Its proposal, if it is triggered. Called in each step in which no higher behaviour is active.
    fn triggered(&self, memory: &mut Self::Memory, situation: &Situation) -> Option<Proposal>;

    /// Called while its destination is not being approached.
    fn judged(&self, _memory: &mut Self::Memory, _verdict: Verdict) {}

    /// The motion while it is active without being triggered.
    fn held(&self) -> Motion;

    /// Its motion while no behaviour proposes anything; `None` if it has none.
    fn idle(&self) -> Option<Motion> {
        None
    }

    /// The heading at which the turn that it proposed last ends, from -pi (excluded) to pi; `None` if
    /// it did not propose a turn on the spot to a heading.
    fn heading_rad(&self, _memory: &Self::Memory) -> Option<f64> {
        None
    }

    /// Called instead of `triggered` while a higher behaviour is active.
    fn suppressed(&self, _memory: &mut Self::Memory) {}
}
