//! Points sorted by the cell that they are in.

use super::grid::Grid;
use base::geometry::Point;

/// Points of so small a number are looked through one by one.
const FEW: usize = 16;

/// Where many things are, so that those near a place are found without looking at all.
///
/// It is filled anew without allocating, as long as it does not grow.
#[derive(Debug, Clone)]
pub(crate) struct Buckets {
    size_m: Point,
    reach_m: f64,
    grid: Grid,
    starts: Vec<u32>,
    cell_of: Vec<u32>,
    sorted: Vec<(Point, u32)>,
}

impl Buckets {
    /// For questions about places some `reach_m` away.
    pub(crate) fn new(size_m: Point, reach_m: f64) -> Self {
        let reach_m = reach_m.max(0.1);
        Self {
            size_m,
            reach_m,
            grid: Grid::over(0, size_m, reach_m),
            starts: Vec::new(),
            cell_of: Vec::new(),
            sorted: Vec::new(),
        }
    }

    /// Takes the points; each is known by its place in their order.
    pub(crate) fn fill(&mut self, points: impl ExactSizeIterator<Item = Point> + Clone) {
        self.sorted.clear();
        if points.len() <= FEW {
            self.sorted.extend(points.zip(0..));
            return;
        }
        self.grid = Grid::over(points.len(), self.size_m, self.reach_m);
        self.count(points.clone());
        self.sorted.resize(points.len(), (Point::default(), 0));
        for ((point, number), cell) in points.zip(0..).zip(&self.cell_of) {
            let place = &mut self.starts[*cell as usize];
            self.sorted[*place as usize] = (point, number);
            *place += 1;
        }
        // Each cell's start has moved to its end, which is where the next one starts.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Where each cell's points will start, and which cell each point is in.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "cells are at most some millions"
    )]
    fn count(&mut self, points: impl Iterator<Item = Point>) {
        let grid = self.grid;
        self.cell_of.clear();
        self.cell_of
            .extend(points.map(|point| grid.cell(point) as u32));
        self.starts.clear();
        self.starts.resize(grid.cells() + 1, 0);
        for cell in &self.cell_of {
            self.starts[*cell as usize + 1] += 1;
        }
        for cell in 0..grid.cells() {
            self.starts[cell + 1] += self.starts[cell];
        }
    }

    /// All points within `radius_m` of a place with their numbers, and maybe some more.
    #[inline]
    pub(crate) fn near(&self, place: Point, radius_m: f64) -> impl Iterator<Item = &(Point, u32)> {
        let few = self.sorted.len() <= FEW;
        let corner = Point {
            x: radius_m,
            y: radius_m,
        };
        let all = few.then_some(&self.sorted[..]).into_iter();
        let rows = (!few).then(|| self.grid.rows_of(corner.to(place), corner.plus(place)));
        let spans = rows.into_iter().flatten().map(|cells| {
            &self.sorted[self.starts[cells.start] as usize..self.starts[cells.end] as usize]
        });
        all.chain(spans).flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn all_points_within_the_radius_are_found_once(
            points in prop::collection::vec((-1.0..11.0, -1.0..21.0), 0..60),
            place in (0.0..10.0, 0.0..20.0),
            radius in 0.0..9.0,
        ) {
            let point = |(x, y)| Point { x, y };
            let points: Vec<Point> = points.into_iter().map(point).collect();
            let place = point(place);
            let mut buckets = Buckets::new(Point { x: 10.0, y: 20.0 }, 1.5);
            buckets.fill(points.iter().copied());
            let is_near = |point: &Point| place.to(*point).length() <= radius;
            let found = buckets.near(place, radius).filter(|(point, _)| is_near(point));
            let mut found: Vec<u32> = found.map(|(_, number)| *number).collect();
            found.sort_unstable();
            let expected: Vec<u32> = points.iter().zip(0..).filter(|(point, _)| is_near(point)).map(|(_, number)| number).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
