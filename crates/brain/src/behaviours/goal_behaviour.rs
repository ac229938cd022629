//! The interface of a behaviour that pursues goals.

use super::behaviour::Behaviour;
use crate::goals::Verdict;
use crate::goals::proposal::{Destination, Proposal};
use crate::io::command::Motion;
use crate::io::goal_id::GoalPlace;
use crate::situation::Situation;
use alloc::boxed::Box;

/// A behaviour that selects places by the robot's beliefs, and stays where nothing is left to do.
/// [Navigation](crate::navigation::navigator) finds the path.
pub(crate) trait GoalBehaviour {
    /// The state that each robot keeps from its first goal on.
    type Progress: Clone;

    /// Whether it searches for items, for which it requires an item detector.
    const SEARCHES: bool = false;

    /// Its destinations, without their goal and place.
    fn destination(&self) -> &Destination;

    /// The destination of this step, or a motion where the robot is. `progress` is `None` until this
    /// method sets it.
    fn goal(
        &self,
        progress: &mut Option<Box<Self::Progress>>,
        situation: &Situation,
    ) -> Option<Proposal>;

    /// Called while its destination is not being approached.
    fn judged(&self, _progress: &mut Self::Progress, _verdict: Verdict) {}

    /// The proposal to be at the place of a goal.
    fn drive_to(&self, GoalPlace { id, at }: GoalPlace) -> Proposal {
        Proposal::Destination(Destination {
            id,
            at,
            ..*self.destination()
        })
    }
}

impl<G: GoalBehaviour> Behaviour for G {
    type Memory = Option<Box<G::Progress>>;

    const NEEDS_BELIEFS: bool = true;
    const NEEDS_DETECTOR: bool = G::SEARCHES;

    fn memory(&self) -> Self::Memory {
        None
    }

    fn triggered(&self, memory: &mut Self::Memory, situation: &Situation) -> Option<Proposal> {
        self.goal(memory, situation)
    }

    fn judged(&self, memory: &mut Self::Memory, verdict: Verdict) {
        if let Some(progress) = memory {
            GoalBehaviour::judged(self, progress, verdict);
        }
    }

    fn held(&self) -> Motion {
        Motion::default()
    }
}
