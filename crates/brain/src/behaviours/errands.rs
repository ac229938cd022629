//! Which places a robot still has to visit, and which of them next.
//!
//! A team that shares places keeps no list together: whoever goes to one says so (a commitment, after Beni
//! and Wang, *Theoretical problems for the realization of distributed robotic systems*, 1991), and says
//! when it has been there. Each robot goes to the nearest place that nobody else goes to. Of two who go to
//! the same, the one with the lower number goes on. What a robot cannot get to it leaves to others, and
//! what one was to visit that has not been heard of for some time is free again.

use crate::io::body::RobotId;
use crate::perception::beliefs::peers::Peers;
use alloc::vec::Vec;
use base::geometry::Point;

/// Places by their numbers in the scenario's list.
#[derive(Debug, Clone, Default)]
pub(crate) struct Errands {
    /// Those that are left, the next one last; those that it could not get to come first.
    left: Vec<u32>,
    /// So many it could not get to since it last got anywhere.
    declined: usize,
    /// Whether the last one is the next: the others of a team may have to be looked at first.
    is_chosen: bool,
    /// So many visits of others it has heard of.
    heard: u32,
}

impl Errands {
    pub(crate) fn new(left: Vec<u32>) -> Self {
        Self {
            left,
            ..Self::default()
        }
    }

    /// The next place in the order of the list.
    pub(crate) fn next(&self, places: &[Point]) -> Option<Point> {
        places.get(*self.left.last()? as usize).copied()
    }

    /// It has been at the next.
    pub(crate) fn pop(&mut self) {
        self.left.pop();
        (self.declined, self.is_chosen) = (0, false);
    }

    /// It cannot get to the next now: all others come first.
    pub(crate) fn decline(&mut self) {
        if let Some(next) = self.left.pop() {
            self.left.insert(0, next);
            self.declined += 1;
        }
        self.is_chosen = false;
    }

    /// The next place for one of a team.
    pub(crate) fn next_of_team(
        &mut self,
        places: &[Point],
        (own, at): (RobotId, Point),
        mates: &Peers,
    ) -> Option<Point> {
        for visited in mates.visits_since(&mut self.heard) {
            self.dismiss(places, *visited);
        }
        let has_better = |id: RobotId| id < own;
        let is_taken = |to| mates.is_any_going_to(to, has_better);
        if !self.is_chosen || self.next(places).is_some_and(is_taken) {
            self.choose(places, at, mates);
        }
        self.next(places).filter(|_| self.is_chosen)
    }

    /// Somebody else has been at a place.
    fn dismiss(&mut self, places: &[Point], visited: Point) {
        let is_it = |number: &u32| places.get(*number as usize) == Some(&visited);
        if self.left.last().is_some_and(is_it) {
            self.is_chosen = false;
        }
        self.left.retain(|number| !is_it(number));
    }

    /// Puts the nearest that nobody else goes to last, if there is one.
    fn choose(&mut self, places: &[Point], at: Point, mates: &Peers) {
        if self.declined >= self.left.len() {
            self.declined = 0;
        }
        let offered = self.left.iter().enumerate().skip(self.declined);
        let free = offered.filter_map(|(number, place)| {
            let to = *places.get(*place as usize)?;
            let is_free = !mates.is_any_going_to(to, |_| true);
            is_free.then(|| (at.to(to).length_squared(), number))
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

    const PLACES: [Point; 4] = [at(0.0), at(3.0), at(6.0), at(9.0)];

    const fn robot(index: u32) -> RobotId {
        RobotId { kind: 0, index }
    }

    fn all() -> Errands {
        Errands::new(vec![0, 1, 2, 3])
    }

    fn next(errands: &mut Errands, own: u32, x: f64, mates: &Peers) -> Option<f64> {
        let to = errands.next_of_team(&PLACES, (robot(own), at(x)), mates);
        to.map(|to| to.x)
    }

    #[test]
    fn each_goes_to_the_nearest_place_that_nobody_else_goes_to() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        mates.update_destination(robot(0), at(3.0), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(0.0));
    }

    #[test]
    fn of_two_who_go_to_the_same_place_the_first_goes_on() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        mates.update_destination(robot(2), at(3.0), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
    }

    #[test]
    fn where_somebody_has_been_nobody_else_goes() {
        let (mut errands, mut mates) = (all(), Peers::default());
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
        for (x, then) in [
            (3.0, Some(0.0)),
            (6.0, Some(0.0)),
            (0.0, Some(9.0)),
            (9.0, None),
        ] {
            mates.update_destination(robot(2), at(x), CommitmentStatus::Done, 0.0);
            assert_eq!(next(&mut errands, 1, 2.0, &mates), then);
        }
    }

    #[test]
    fn what_one_cannot_get_to_is_tried_again_after_all_others() {
        let (mut errands, mates) = (all(), Peers::default());
        let mut order = Vec::new();
        for _ in 0..5 {
            order.push(next(&mut errands, 1, 2.0, &mates));
            errands.decline();
        }
        assert_eq!(order, [3.0, 0.0, 6.0, 9.0, 3.0].map(Some));
    }

    #[test]
    fn who_is_not_heard_of_any_more_leaves_its_place_to_others() {
        let (mut errands, mut mates) = (Errands::new(vec![1]), Peers::default());
        mates.update_destination(robot(0), at(3.0), CommitmentStatus::Active, 0.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), None);
        mates.advance(11.0);
        assert_eq!(next(&mut errands, 1, 2.0, &mates), Some(3.0));
    }
}
