//! The waypoints that a robot has yet to visit, and the next one of them.
//!
//! A team that shares waypoints keeps no common list: a robot announces its destination (a
//! commitment, after Beni and Wang, *Theoretical problems for the realization of distributed robotic
//! systems*, 1991), and its visits. Each robot drives to the nearest waypoint without a commitment of
//! another robot. If two commit to the same one, the robot with the lower id keeps it. Unreachable
//! waypoints are left to others, and a commitment expires when its robot has sent nothing for some
//! time.

use crate::io::agent_id::AgentId;
use crate::io::goal_id::{GoalId, GoalPlace, Issuer, issuer_of};
use crate::messaging::peers::Peers;
use alloc::vec::Vec;
use base::geometry::Point;

/// A list of waypoints as goals, which are the same for all robots with the same list.
#[derive(Debug, Clone)]
pub(crate) struct Waypoints {
    issuer: Issuer,
    places: Vec<Point>,
}

impl Waypoints {
    pub(crate) fn new(places: &[Point]) -> Self {
        Self {
            issuer: issuer_of(places),
            places: places.to_vec(),
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "ten thousand at most")]
    pub(crate) fn count(&self) -> u32 {
        self.places.len() as u32
    }

    fn get(&self, number: u32) -> Option<GoalPlace> {
        let at = *self.places.get(number as usize)?;
        let issuer = self.issuer;
        Some(GoalPlace {
            id: GoalId { issuer, number },
            at,
        })
    }
}

/// Waypoints by their indices in the scenario's list.
#[derive(Debug, Clone, Default)]
pub(crate) struct Errands {
    /// The remaining waypoints: the next one last, declined ones first.
    left: Vec<u32>,
    /// Number of waypoints declined since the last visit.
    declined: usize,
    /// Whether the last one has been selected, given the commitments of the team.
    is_chosen: bool,
    /// Number of visits by other robots that have been processed.
    visits_processed: u32,
}

impl Errands {
    pub(crate) fn new(left: Vec<u32>) -> Self {
        Self {
            left,
            ..Self::default()
        }
    }

    /// The next waypoint in the order of the list.
    pub(crate) fn next(&self, waypoints: &Waypoints) -> Option<GoalPlace> {
        waypoints.get(*self.left.last()?)
    }

    /// Removes the next waypoint, which has been visited.
    pub(crate) fn pop(&mut self) {
        self.left.pop();
        (self.declined, self.is_chosen) = (0, false);
    }

    /// Moves the next waypoint, which is unreachable now, behind all others.
    pub(crate) fn decline(&mut self) {
        if let Some(next) = self.left.pop() {
            self.left.insert(0, next);
            self.declined += 1;
        }
        self.is_chosen = false;
    }

    /// The next waypoint of a robot in a team that shares them.
    pub(crate) fn next_of_team(
        &mut self,
        waypoints: &Waypoints,
        (own, at): (AgentId, Point),
        mates: &Peers,
    ) -> Option<GoalPlace> {
        for visited in mates.visits_since(&mut self.visits_processed) {
            self.dismiss(waypoints, *visited);
        }
        let has_better = |id: AgentId| id < own;
        let is_taken = |to: GoalPlace| mates.is_any_going_to(to.id, has_better);
        if !self.is_chosen || self.next(waypoints).is_some_and(is_taken) {
            self.choose(waypoints, at, mates);
        }
        self.next(waypoints).filter(|_| self.is_chosen)
    }

    /// Removes a waypoint that another robot has visited.
    fn dismiss(&mut self, waypoints: &Waypoints, visited: GoalId) {
        let is_it = |number: &u32| {
            let (issuer, number) = (waypoints.issuer, *number);
            visited == GoalId { issuer, number }
        };
        if self.left.last().is_some_and(is_it) {
            self.is_chosen = false;
        }
        self.left.retain(|number| !is_it(number));
    }

    /// Selects the nearest waypoint without a commitment of another robot, if there is one.
    fn choose(&mut self, waypoints: &Waypoints, at: Point, mates: &Peers) {
        if self.declined >= self.left.len() {
            self.declined = 0;
        }
        let offered = self.left.iter().enumerate().skip(self.declined);
        let free = offered.filter_map(|(number, place)| {
            let to = waypoints.get(*place)?;
            let is_free = !mates.is_any_going_to(to.id, |_| true);
            is_free.then(|| (at.to(to.at).length_squared(), number))
        });
        let nearest = free.min_by(|one, other| one.0.total_cmp(&other.0));
        self.is_chosen = nearest.is_some();
        if let Some((_, number)) = nearest {
            let last = self.left.len() - 1;
            self.left.swap(number, last);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::message::CommitmentStatus;

    const fn at(x: f64) -> Point {
        Point { x, y: 0.0 }
    }

    const WAYPOINTS: [Point; 4] = [at(0.0), at(3.0), at(6.0), at(9.0)];

    const fn robot(index: u32) -> AgentId {
        AgentId::robot(0, index)
    }

    fn waypoint(number: u32) -> GoalPlace {
        Waypoints::new(&WAYPOINTS).get(number).unwrap()
    }

    fn all() -> Errands {
        Errands::new(vec![0, 1, 2, 3])
    }

    fn next(errands: &mut Errands, own: u32, x: f64, mates: &Peers) -> Option<f64> {
        let waypoints = Waypoints::new(&WAYPOINTS);
        let to = errands.next_of_team(&waypoints, (robot(own), at(x)), mates);
        to.map(|to| to.at.x)
    }

    #[test]
    fn a_robot_selects_the_nearest_waypoint_without_a_commitment() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        mates.update_destination(robot(0), waypoint(1), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(0.0));
    }

    #[test]
    fn of_two_robots_with_the_same_waypoint_the_lower_id_keeps_it() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        mates.update_destination(robot(2), waypoint(1), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
    }

    #[test]
    fn visited_waypoints_are_removed() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        for (number, then) in [(1, Some(0.0)), (2, Some(0.0)), (0, Some(9.0)), (3, None)] {
            mates.update_destination(robot(2), waypoint(number), CommitmentStatus::Done, 0.0);
            assert_eq!(next(&mut errands, 1, 2.0, &mates), then);
        }
    }

    #[test]
    fn a_waypoint_that_a_mate_visited_is_removed_but_not_another_one_at_the_same_place() {
        let waypoints = Waypoints::new(&[at(3.0), at(6.0), at(3.0)]);
        let (mut errands, mut mates) = (Errands::new(vec![0, 1, 2]), Peers::default());
        let visited = waypoints.get(0).unwrap();
        mates.update_destination(robot(2), visited, CommitmentStatus::Done, 0.0);
        let next = errands.next_of_team(&waypoints, (robot(1), at(3.0)), &mates);
        assert_eq!(next, waypoints.get(2));
        assert_eq!(errands.left.len(), 2);
    }

    #[test]
    fn a_commitment_to_a_waypoint_of_another_list_at_the_same_place_leaves_it_free() {
        let (mut errands, mut mates) = (all(), Peers::default());
        let other = Waypoints::new(&[at(9.0), at(3.0)]).get(1).unwrap();
        for status in [CommitmentStatus::Active, CommitmentStatus::Done] {
            mates.update_destination(robot(0), other, status, 0.0);
            assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        }
    }

    #[test]
    fn an_unreachable_waypoint_is_tried_again_after_all_others() {
        let (mut errands, mates) = (all(), Peers::default());
        let mut order = Vec::new();
        for _ in 0..5 {
            order.push(next(&mut errands, 1, 2.0, &mates));
            errands.decline();
        }
        assert_eq!(order, [3.0, 0.0, 6.0, 9.0, 3.0].map(Some));
    }

    #[test]
    fn a_commitment_expires_without_messages() {
        let (mut errands, mut mates) = (Errands::new(vec![1]), Peers::default());
        mates.update_destination(robot(0), waypoint(1), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), None);
        mates.advance(11.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
    }
}
