//! Points sorted by the cell that they are in.

use super::grid::Grid;
use base::geometry::{Point, Torus};

/// Up to this number of points are searched linearly.
const FEW: usize = 16;

/// An index of points, so that those near a place are found without checking all.
///
/// It is refilled without allocating, as long as it does not grow.
#[derive(Debug, Clone)]
pub(crate) struct Buckets {
    size_m: Point,
    reach_m: f64,
    grid: Grid,
    starts: Vec<u32>,
    cell_of: Vec<u32>,
    sorted: Vec<(Point, u32)>,
    images: Option<Images>,
}

/// Points of a periodic world, and their images near its rectangle.
#[derive(Debug, Clone)]
struct Images {
    torus: Torus,
    reach_m: f64,
    points: Vec<(Point, u32)>,
}

impl Buckets {
    /// For queries of about `reach_m`.
    pub(crate) fn new(size_m: Point, reach_m: f64) -> Self {
        let reach_m = reach_m.max(0.1);
        Self {
            images: None,
            size_m,
            reach_m,
            grid: Grid::over(0, size_m, reach_m),
            starts: Vec::new(),
            cell_of: Vec::new(),
            sorted: Vec::new(),
        }
    }

    /// With all images of points for queries of at most `farthest_m`, if the world is periodic.
    pub(crate) fn on(mut self, torus: Option<Torus>, farthest_m: f64) -> Self {
        self.images = torus.map(|torus| Images {
            torus,
            reach_m: farthest_m,
            points: Vec::new(),
        });
        self
    }

    /// Takes the points; each is identified by its index.
    pub(crate) fn fill(&mut self, points: impl ExactSizeIterator<Item = Point> + Clone) {
        self.take(points.len(), points.zip(0..));
    }

    /// Takes points with their numbers.
    pub(crate) fn fill_numbered(&mut self, points: &[(Point, u32)]) {
        self.take(points.len(), points.iter().copied());
    }

    fn take(&mut self, count: usize, points: impl Iterator<Item = (Point, u32)> + Clone) {
        let Some(mut images) = self.images.take() else {
            return self.sort(count, points);
        };
        images.fill(points);
        self.sort(images.points.len(), images.points.iter().copied());
        self.images = Some(images);
    }

    fn sort(&mut self, count: usize, points: impl Iterator<Item = (Point, u32)> + Clone) {
        self.sorted.clear();
        if count <= FEW {
            self.sorted.extend(points);
            return;
        }
        self.grid = Grid::over(count, self.size_m, self.reach_m);
        self.count(points.clone().map(|(point, _)| point));
        self.sorted.resize(count, (Point::default(), 0));
        for (point, cell) in points.zip(&self.cell_of) {
            let place = &mut self.starts[*cell as usize];
            self.sorted[*place as usize] = point;
            *place += 1;
        }
        // Each cell's start has moved to its end, which is where the next one starts.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Where the points of each cell will start, and the cell of each point.
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

    /// All points within `radius_m` of a place with their numbers, and possibly some more; in a
    /// periodic world as their images there.
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

impl Images {
    fn fill(&mut self, points: impl Iterator<Item = (Point, u32)> + Clone) {
        let (torus, reach_m) = (self.torus, self.reach_m);
        let images = points.clone().flat_map(|(point, number)| {
            let images = torus.images_within(point, reach_m);
            images.map(move |image| (image, number))
        });
        self.points.clear();
        self.points.extend(points);
        self.points.extend(images);
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

        #[test]
        fn on_a_torus_all_points_within_the_radius_are_found_once_across_its_sides(
            points in prop::collection::vec((0.0..10.0, 0.0..20.0), 0..60),
            place in (0.0..10.0, 0.0..20.0),
            radius in 0.0..5.0,
        ) {
            let point = |(x, y)| Point { x, y };
            let points: Vec<Point> = points.into_iter().map(point).collect();
            let (place, torus) = (point(place), Torus { size_m: Point { x: 10.0, y: 20.0 } });
            let mut buckets = Buckets::new(torus.size_m, 1.5).on(Some(torus), 5.0);
            buckets.fill(points.iter().copied());
            let is_near = |point: &Point| place.to(*point).length() <= radius;
            let found = buckets.near(place, radius).filter(|(point, _)| is_near(point));
            let mut found: Vec<u32> = found.map(|(_, number)| *number).collect();
            found.sort_unstable();
            let images = points.iter().map(|point| torus.image(place, *point));
            let expected = images.zip(0..).filter(|(point, _)| is_near(point));
            let expected: Vec<u32> = expected.map(|(_, number)| number).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
