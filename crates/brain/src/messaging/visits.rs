//! The visits of a robot that it repeats to its team.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::GoalPlace;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of visits; the oldest is dropped first.
const MAX_VISITS: usize = 64;

/// The own visits of goals that other robots may have too, and which of them is repeated next.
#[derive(Debug, Clone, Default, Hashed)]
pub(super) struct OwnVisits {
    visits: Vec<GoalPlace>,
    next: u8,
}

impl OwnVisits {
    /// Adds a visit, unless the goal is one that the robot chose itself or that a controller has planned: no other
    /// robot has that.
    pub(super) fn add(&mut self, goal: GoalPlace) {
        let issuer = goal.id.issuer.agent();
        if issuer.is_some_and(|id| id != AgentId::OPERATOR) {
            return;
        }
        if self.visits.len() == MAX_VISITS {
            self.visits.remove(0);
        }
        self.visits.push(goal);
    }

    /// The visit to repeat now: each in turn.
    pub(super) fn next(&mut self) -> Option<GoalPlace> {
        let next = usize::from(self.next).checked_rem(self.visits.len())?;
        self.next = u8::try_from(next + 1).unwrap_or(0);
        self.visits.get(next).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::goal_id::{GoalId, GoalList, Issuer};
    use base::geometry::Point;

    const SHARED: Issuer = Issuer::List(GoalList { list: 1 });
    const OWN: Issuer = Issuer::Agent(AgentId::robot(0, 1));

    fn goal(issuer: Issuer, number: u32) -> GoalPlace {
        GoalPlace {
            id: GoalId { issuer, number },
            at: Point::default(),
        }
    }

    fn repeated(visits: &mut OwnVisits, times: usize) -> Vec<u32> {
        let all = core::iter::repeat_with(|| visits.next()).take(times);
        all.flatten().map(|goal| goal.id.number).collect()
    }

    #[test]
    fn visits_of_shared_waypoints_are_repeated_in_turn() {
        let mut visits = OwnVisits::default();
        (0..3).for_each(|number| visits.add(goal(SHARED, number)));
        assert_eq!(repeated(&mut visits, 7), [0, 1, 2, 0, 1, 2, 0]);
    }

    #[test]
    fn visits_of_goals_that_the_robot_chose_itself_are_not_repeated() {
        let mut visits = OwnVisits::default();
        visits.add(goal(OWN, 1));
        assert_eq!(visits.next(), None);
    }

    #[test]
    fn the_number_of_visits_is_bounded_and_the_oldest_is_dropped() {
        let mut visits = OwnVisits::default();
        (0..100).for_each(|number| visits.add(goal(SHARED, number)));
        let all = repeated(&mut visits, 2 * MAX_VISITS);
        assert_eq!(all.iter().min(), Some(&36));
        assert_eq!(all[..MAX_VISITS], all[MAX_VISITS..]);
    }
}
