//! The shortest path through several places, from where the robot is, with any end.
//!
//! Exact for up to [`MAX_EXACT`] places by dynamic programming over sets of places (Held and Karp, *A
//! dynamic programming approach to sequencing problems*, 1962; Bellman 1962). Beyond, places are
//! inserted one by one where they lengthen the path least, which is on average some percent longer.

use alloc::vec::Vec;
use base::geometry::Point;

/// Maximum number of places of an exact path, with the one that is added to it.
pub(crate) const MAX_EXACT: usize = 8;

/// A path through places.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tour {
    start: Point,
    places: Vec<Point>,
    /// Indices of the places.
    pub(crate) order: Vec<usize>,
    pub(crate) length_m: f64,
    /// For each set of places and each of them, by set: the shortest path from the start over the set
    /// that ends there, and the shortest path over the set that begins there. Empty if not exact.
    ending_m: Vec<f64>,
    beginning_m: Vec<f64>,
}

impl Tour {
    /// The shortest path from a start.
    pub(crate) fn new(start: Point, places: &[Point]) -> Self {
        let mut tour = Self {
            start,
            places: places.to_vec(),
            ..Self::default()
        };
        if places.len() < MAX_EXACT {
            tour.expand();
            tour.order = tour.traced();
        } else {
            tour.insert_all();
        }
        tour.length_m = tour.along_m(&tour.order);
        tour
    }

    /// By how much the shortest path becomes longer with another place.
    pub(crate) fn increment_m(&self, place: Point) -> f64 {
        if self.ending_m.is_empty() {
            return self.insertion(place).1;
        }
        let all = (1 << self.places.len()) - 1;
        let totals =
            (0..=all).map(|set| self.up_to_m(set, place) + self.onwards_m(all ^ set, place));
        (totals.fold(f64::INFINITY, f64::min) - self.length_m).max(0.0)
    }

    /// Length of the path to a place that is inserted where that lengthens the path least.
    pub(crate) fn arrival_m(&self, place: Point) -> f64 {
        let (at, _) = self.insertion(place);
        let before = &self.order[..at];
        let last = before
            .last()
            .map_or(self.start, |index| self.places[*index]);
        self.along_m(before) + last.to(place).length()
    }

    /// Shortest path from the start over a set to a place.
    fn up_to_m(&self, set: usize, place: Point) -> f64 {
        if set == 0 {
            return self.start.to(place).length();
        }
        self.shortest_m(set, |end| {
            self.ending_m[set * self.places.len() + end] + self.places[end].to(place).length()
        })
    }

    /// Shortest path from a place over a set.
    fn onwards_m(&self, set: usize, place: Point) -> f64 {
        if set == 0 {
            return 0.0;
        }
        self.shortest_m(set, |first| {
            self.beginning_m[set * self.places.len() + first]
                + place.to(self.places[first]).length()
        })
    }

    fn shortest_m(&self, set: usize, length_m: impl Fn(usize) -> f64) -> f64 {
        let members = (0..self.places.len()).filter(|place| set >> place & 1 == 1);
        members.map(length_m).fold(f64::INFINITY, f64::min)
    }

    fn expand(&mut self) {
        let count = self.places.len();
        self.ending_m = alloc::vec![f64::INFINITY; count << count];
        self.beginning_m = self.ending_m.clone();
        for set in 1..1_usize << count {
            for place in (0..count).filter(|place| set >> place & 1 == 1) {
                let others = set ^ 1 << place;
                let at = self.places[place];
                self.ending_m[set * count + place] = self.up_to_m(others, at);
                self.beginning_m[set * count + place] = self.onwards_m(others, at);
            }
        }
    }

    /// The order of the shortest path over all places: at each, the next one of a shortest rest.
    fn traced(&self) -> Vec<usize> {
        let count = self.places.len();
        let (mut left, mut at, mut order) = ((1_usize << count) - 1, self.start, Vec::new());
        while left != 0 {
            let members = (0..count).filter(|place| left >> place & 1 == 1);
            let length_m = |place: &usize| {
                at.to(self.places[*place]).length() + self.beginning_m[left * count + place]
            };
            let next = members.min_by(|one, other| length_m(one).total_cmp(&length_m(other)));
            let Some(next) = next else {
                break;
            };
            order.push(next);
            (left, at) = (left ^ 1 << next, self.places[next]);
        }
        order
    }

    fn insert_all(&mut self) {
        for index in 0..self.places.len() {
            let (at, _) = self.insertion(self.places[index]);
            self.order.insert(at, index);
        }
    }

    /// Where to insert a place, and by how much it lengthens the path.
    fn insertion(&self, place: Point) -> (usize, f64) {
        let mut best = (0, f64::INFINITY);
        let mut before = self.start;
        for at in 0..=self.order.len() {
            let there_m = before.to(place).length();
            let after = self.order.get(at).map(|index| self.places[*index]);
            let added_m = after.map_or(there_m, |after| {
                there_m + place.to(after).length() - before.to(after).length()
            });
            if added_m < best.1 {
                best = (at, added_m);
            }
            before = after.unwrap_or(before);
        }
        (best.0, best.1.max(0.0))
    }

    fn along_m(&self, order: &[usize]) -> f64 {
        let places = order.iter().map(|index| self.places[*index]);
        let (length_m, _) = places.fold((0.0, self.start), |(length_m, at), next| {
            (length_m + at.to(next).length(), next)
        });
        length_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(most: usize) -> impl Strategy<Value = Vec<Point>> {
        let point = [0.0..100.0, 0.0..100.0].prop_map(Point::from);
        proptest::collection::vec(point, 1..most)
    }

    /// The length of the shortest path by trying all orders.
    fn brute_force_m(at: Point, left: &[Point]) -> f64 {
        if left.is_empty() {
            return 0.0;
        }
        let lengths_m = (0..left.len()).map(|next| {
            let mut rest = left.to_vec();
            let place = rest.remove(next);
            at.to(place).length() + brute_force_m(place, &rest)
        });
        lengths_m.fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn the_path_through_few_places_is_the_shortest(places in points(7)) {
            let tour = Tour::new(Point::default(), &places);
            prop_assert!((tour.length_m - brute_force_m(Point::default(), &places)).abs() < 1e-6);
        }

        #[test]
        fn the_increment_is_that_of_the_shortest_paths(places in points(7)) {
            let (last, others) = places.split_last().unwrap();
            let [with_m, without_m] = [&places, others].map(|all| brute_force_m(Point::default(), all));
            let increment_m = Tour::new(Point::default(), others).increment_m(*last);
            prop_assert!((increment_m - (with_m - without_m)).abs() < 1e-6);
        }

        #[test]
        fn a_path_visits_each_place_once_whatever_their_number(places in points(30)) {
            let tour = Tour::new(Point::default(), &places);
            let mut order = tour.order.clone();
            order.sort_unstable();
            prop_assert!(order.into_iter().eq(0..places.len()));
            prop_assert!(tour.arrival_m(places[0]) <= tour.length_m + tour.increment_m(places[0]) + 1e-6);
        }
    }

    #[test]
    fn insertion_is_at_most_some_percent_longer_than_the_shortest_path() {
        use base::random::{Entity, Purpose, stream};
        let mut random = stream(3, 0, Entity { kind: 0, index: 0 }, Purpose::Start);
        let mut unit = || f64::from(random.next_u32()) / f64::from(u32::MAX);
        let (mut exact_m, mut inserted_m) = (0.0, 0.0);
        for _ in 0..300 {
            let places: Vec<Point> = (0..7).map(|_| Point::from([unit(), unit()])).collect();
            exact_m += Tour::new(Point::default(), &places).length_m;
            let mut tour = Tour {
                places: places.clone(),
                ..Tour::default()
            };
            tour.insert_all();
            inserted_m += tour.along_m(&tour.order);
        }
        let ratio = inserted_m / exact_m;
        assert!(ratio > 1.0 && ratio < 1.06, "{ratio}");
    }
}
