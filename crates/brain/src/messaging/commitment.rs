//! The destination that a robot is committed to, and whether it is done.

use crate::goals::proposal::Destination;
use crate::perception::beliefs::pose::Pose;
use crate::service::assignee::Assignee;

/// The current destination, and the goals of controllers that the robot serves.
#[derive(Clone, Copy)]
pub(crate) struct Commitment<'s> {
    pub(crate) goal: Option<Destination>,
    pub(crate) service: Option<&'s Assignee>,
}

impl Commitment<'_> {
    /// The destination after the previous one: a robot that stands at a goal which it serves has
    /// none, and remains committed to the goal.
    pub(super) fn after(&self, previous: Option<Destination>) -> Option<Destination> {
        let is_served = |goal: &Destination| {
            let service = self.service;
            service.is_some_and(|service| service.serves(goal.id))
        };
        self.goal.or_else(|| previous.filter(is_served))
    }

    /// Whether a destination that the robot leaves is done: the service of a goal takes time.
    pub(super) fn is_done(&self, left: &Destination, pose: &Pose) -> bool {
        let has_served = self.service.and_then(|service| service.has_served(left.id));
        has_served.unwrap_or_else(|| left.is_reached(pose.at, pose.deviation_m))
    }
}
