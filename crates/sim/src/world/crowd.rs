//! Discs that may be put elsewhere, found by where they are.

use super::grid::Grid;
use base::geometry::{Disc, Point};
use std::collections::HashMap;

/// Which discs are in each cell. Memory goes with their number, never with the world's size.
#[derive(Debug, Clone)]
pub(crate) struct Crowd {
    grid: Grid,
    biggest_m: f64,
    cells: HashMap<usize, Vec<usize>>,
}

impl Crowd {
    /// These discs; each is known by its place in their order.
    pub(crate) fn new(size_m: Point, discs: &[Disc]) -> Self {
        let radii_m = discs.iter().map(|disc| disc.radius_m);
        let biggest_m = radii_m.fold(0.0, f64::max);
        let mut crowd = Self {
            grid: Grid::new(size_m, (2.0 * biggest_m).max(0.1)),
            biggest_m,
            cells: HashMap::new(),
        };
        for (number, disc) in discs.iter().enumerate() {
            crowd.cell(disc.centre).push(number);
        }
        crowd
    }

    /// A disc is elsewhere.
    pub(crate) fn put(&mut self, number: usize, from: Point, to: Point) {
        self.cell(from).retain(|other| *other != number);
        self.cell(to).push(number);
    }

    /// All discs that one of this radius overlaps at a place, and maybe some more.
    pub(crate) fn near(&self, place: Point, radius_m: f64) -> impl Iterator<Item = usize> + '_ {
        let reach_m = radius_m + self.biggest_m;
        let corner = Point {
            x: reach_m,
            y: reach_m,
        };
        let rows = self.grid.rows_of(corner.to(place), corner.plus(place));
        let lists = rows.flatten().filter_map(|cell| self.cells.get(&cell));
        lists.flatten().copied()
    }

    fn cell(&mut self, place: Point) -> &mut Vec<usize> {
        self.cells.entry(self.grid.cell(place)).or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn disc() -> impl Strategy<Value = Disc> {
        (-1.0..11.0, -1.0..21.0, 0.0..1.5).prop_map(|(x, y, radius_m)| Disc {
            centre: Point { x, y },
            radius_m,
        })
    }

    proptest! {
        #[test]
        fn all_discs_that_one_overlaps_are_found_once_wherever_they_were_put(
            discs in prop::collection::vec(disc(), 1..60),
            moves in prop::collection::vec((0_usize..60, disc()), 0..60),
            one in disc(),
        ) {
            let mut discs = discs;
            let mut crowd = Crowd::new(Point { x: 10.0, y: 20.0 }, &discs);
            for (number, to) in moves {
                let number = number % discs.len();
                crowd.put(number, discs[number].centre, to.centre);
                discs[number].centre = to.centre;
            }
            let overlaps = |number: &usize| discs[*number].distance_m(one.centre) < one.radius_m;
            let found = crowd.near(one.centre, one.radius_m).filter(overlaps);
            let mut found: Vec<usize> = found.collect();
            found.sort_unstable();
            let expected: Vec<usize> = (0..discs.len()).filter(overlaps).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
