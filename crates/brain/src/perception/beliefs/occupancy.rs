//! The occupancy grid that range scans are integrated into.

use super::field::Field;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};
use base::hashed::Hashed;
use core::ops::Range;

/// Change of the log odds of a cell in which a ray ends, and of one that it passes, in quarters of
/// a nat.
const HIT: i8 = 4;
const PASS: i8 = -1;

/// Limit of the log odds, so that obstacles that disappear are forgotten: odds of e^5.
const MAX_LOG_ODDS: i8 = 20;

/// From these log odds on, a cell counts as occupied: odds of e^1, 73%.
const OCCUPIED: i8 = 4;

/// The cells of a field, each with the log odds that it is occupied.
///
/// After Moravec and Elfes, *High resolution maps from wide angle sonar*, ICRA 1985, with log odds:
/// each ray adds [`HIT`] to the cell in which it ends and [`PASS`] to those that it passes. Nine
/// bits per cell.
///
/// An occupied cell is stale if no ray has ended in it since [`Occupancy::mark_stale`]: what was there may
/// have left out of sight.
///
/// A wall at a grazing angle ends few rays, while many pass through cells that it occupies in part.
/// A ray therefore clears cells only as far as its neighbours reach, and each cell about once per
/// scan.
#[derive(Debug, Clone, Hashed)]
pub(crate) struct Occupancy {
    quarter_nats: Vec<i8>,
    /// The cells that the previous ray passed, in order.
    #[hashed(skip)]
    passed: Vec<usize>,
    /// Number of cells that have become occupied, free, or stale no more, so far.
    pub(crate) changes: u32,
    /// Whether each cell has been occupied since the map was marked stale, or ever if it never was, in
    /// groups of 64.
    confirmed: Vec<u64>,
    /// Number of cells that have become confirmed so far.
    pub(crate) discoveries: u32,
}

/// A measured ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// Its free part, limited by its neighbours.
    pub(crate) free: Segment,
    /// The position of the obstacle, if any.
    pub(crate) hit: Option<Point>,
}

impl Occupancy {
    pub(crate) fn new(field: &Field) -> Self {
        Self {
            quarter_nats: vec![0; field.cells()],
            passed: Vec::with_capacity(field.columns.max(field.rows) + 1),
            changes: 0,
            confirmed: vec![0; field.cells().div_ceil(64)],
            discoveries: 0,
        }
    }

    /// Whether a cell counts as occupied.
    #[inline]
    pub(crate) fn is_occupied(&self, cell: usize) -> bool {
        self.quarter_nats
            .get(cell)
            .is_some_and(|odds| *odds >= OCCUPIED)
    }

    /// Whether an occupied cell is stale.
    pub(crate) fn is_stale(&self, cell: usize) -> bool {
        let group = self.confirmed.get(cell / 64);
        group.is_some_and(|group| group & (1 << (cell % 64)) == 0)
    }

    /// Marks all occupied cells as stale until they are observed again.
    pub(crate) fn mark_stale(&mut self) {
        self.confirmed.fill(0);
    }

    /// Whether any cell within columns and rows counts as occupied.
    pub(crate) fn is_any_in(
        &self,
        field: &Field,
        columns: &Range<usize>,
        rows: &Range<usize>,
    ) -> bool {
        rows.clone().any(|row| {
            let first = row * field.columns;
            let cells = self
                .quarter_nats
                .get(first + columns.start..first + columns.end);
            cells.is_some_and(|cells| cells.iter().any(|odds| *odds >= OCCUPIED))
        })
    }

    /// All cells that count as occupied.
    pub(crate) fn occupied(&self) -> impl Iterator<Item = usize> {
        let cells = self.quarter_nats.iter().enumerate();
        cells
            .filter(|(_, odds)| **odds >= OCCUPIED)
            .map(|(cell, _)| cell)
    }

    /// Probability that each cell is occupied, in percent; -1 if unknown.
    pub(crate) fn percent(&self) -> impl Iterator<Item = i8> {
        let percents: [i8; 2 * MAX_LOG_ODDS as usize + 1] = core::array::from_fn(percent);
        let index = |odds: i8| usize::from((odds + MAX_LOG_ODDS).unsigned_abs());
        self.quarter_nats
            .iter()
            .map(move |odds| percents[index(*odds)])
    }

    /// Starts a new scan; its rays are added in order.
    pub(crate) fn begin_scan(&mut self) {
        self.passed.clear();
    }

    /// Adds a ray of the current scan.
    #[inline]
    pub(crate) fn add_ray(&mut self, field: &Field, ray: &Ray) {
        let hit = ray.hit.and_then(|hit| field.cell(hit));
        for (index, cell) in field.crossed(ray.free.from, ray.free.to).enumerate() {
            let before = self.passed.get(index).copied();
            if before != Some(cell) && hit != Some(cell) {
                self.add(cell, PASS);
            }
            match self.passed.get_mut(index) {
                Some(passed) => *passed = cell,
                None => self.passed.push(cell),
            }
        }
        if let Some(cell) = hit {
            self.add(cell, HIT);
        }
    }

    #[inline]
    fn add(&mut self, cell: usize, change: i8) {
        if let Some(odds) = self.quarter_nats.get_mut(cell) {
            let was_occupied = *odds >= OCCUPIED;
            *odds = (*odds + change).clamp(-MAX_LOG_ODDS, MAX_LOG_ODDS);
            let is_occupied = *odds >= OCCUPIED;
            if was_occupied != is_occupied {
                self.changes = self.changes.wrapping_add(1);
            }
            if is_occupied && change > 0 && self.confirm(cell) {
                self.discoveries = self.discoveries.wrapping_add(1);
                self.changes = self.changes.wrapping_add(u32::from(was_occupied));
            }
        }
    }

    /// Confirms that a cell is occupied; returns whether it was not confirmed before.
    fn confirm(&mut self, cell: usize) -> bool {
        let bit = 1 << (cell % 64);
        self.confirmed.get_mut(cell / 64).is_some_and(|group| {
            let is_new = *group & bit == 0;
            *group |= bit;
            is_new
        })
    }

    /// Whether no known obstacle hides a position from another. Obstacles at the position itself,
    /// or closer to it than `blur_m`, do not hide it.
    pub(crate) fn is_visible(&self, field: &Field, from: Point, to: Point, blur_m: f64) -> bool {
        let line = from.to(to);
        let length_m = line.length();
        let clear_m = length_m - field.cell_m - blur_m;
        clear_m <= 0.0 || {
            let before = from.plus(line.times(clear_m / length_m));
            self.is_free_between(field, from, before)
        }
    }

    /// Whether the straight line between two positions crosses no occupied cell, and does not pass
    /// between two that touch at a corner.
    pub(crate) fn is_free_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let line = from.to(to);
        let length_m = line.length();
        let direction = line.times(1.0 / length_m.max(f64::MIN_POSITIVE));
        let mut last = field.cell(from);
        field.along(from, direction, length_m).all(|cell| {
            let before = last.replace(cell).unwrap_or(cell);
            !self.is_occupied(cell) && !self.is_diagonal_gap(field, before, cell)
        })
    }

    /// Whether two cells touch at a corner only, and both cells beside that corner are occupied.
    fn is_diagonal_gap(&self, field: &Field, one: usize, other: usize) -> bool {
        let across = one.abs_diff(other).abs_diff(field.columns);
        across == 1 && {
            let [[left, low], [right, high]] =
                [one, other].map(|cell| field.column_and_row_of(cell));
            let is_occupied = |column, row| {
                let cell = field.number(column, row);
                cell.is_some_and(|cell| self.is_occupied(cell))
            };
            is_occupied(left, high) && is_occupied(right, low)
        }
    }
}

/// Probability in percent for log odds in quarter nats above the minimum; -1 if they are even.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "0 to 100, from 0 to 40"
)]
fn percent(above_min: usize) -> i8 {
    let nats = (above_min as f64 - f64::from(MAX_LOG_ODDS)) / 4.0;
    if nats == 0.0 {
        return -1;
    }
    libm::round(100.0 / (1.0 + libm::exp(-nats))) as i8
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::geometry::Rectangle;

    fn field() -> Field {
        let corner = Point { x: 10.0, y: 10.0 };
        Field::new(&Rectangle::spanned(Point::default(), corner), 0.5, 10_000)
    }

    fn scan(map: &mut Occupancy, free_m: f64, is_hit: bool) {
        let free = Segment {
            from: Point { x: 1.0, y: 5.25 },
            to: Point {
                x: 1.0 + free_m,
                y: 5.25,
            },
        };
        map.begin_scan();
        let hit = is_hit.then_some(free.to);
        map.add_ray(&field(), &Ray { free, hit });
    }

    fn is_occupied(map: &Occupancy, x: f64) -> bool {
        map.is_occupied(field().cell(Point { x, y: 5.25 }).unwrap())
    }

    #[test]
    fn a_wall_is_occupied_and_the_cells_before_it_are_free() {
        let mut map = Occupancy::new(&field());
        scan(&mut map, 4.1, true);
        assert!(is_occupied(&map, 5.1) && map.changes == 1);
        assert!((2..10).all(|half| !is_occupied(&map, 0.1 + 0.5 * f64::from(half))));
        let (near, far) = (Point { x: 1.0, y: 5.25 }, Point { x: 9.0, y: 5.25 });
        assert!(!map.is_free_between(&field(), near, far));
        assert!(map.is_free_between(&field(), near, Point { x: 4.9, y: 5.25 }));
    }

    #[test]
    fn a_removed_obstacle_is_forgotten_within_twenty_scans() {
        let mut map = Occupancy::new(&field());
        (0..100).for_each(|_| scan(&mut map, 4.1, true));
        let scans = (0..).take_while(|_| {
            scan(&mut map, 8.0, false);
            is_occupied(&map, 5.1)
        });
        assert!((10..20).contains(&scans.count()));
    }

    #[test]
    fn a_cell_that_is_occupied_again_is_not_counted_again() {
        let mut map = Occupancy::new(&field());
        for _ in 0..3 {
            (0..100).for_each(|_| scan(&mut map, 4.1, true));
            (0..100).for_each(|_| scan(&mut map, 8.0, false));
        }
        assert_eq!((map.changes, map.discoveries), (6, 1));
        scan(&mut map, 6.1, true);
        assert_eq!(map.discoveries, 1);
        (0..10).for_each(|_| scan(&mut map, 6.1, true));
        assert_eq!(map.discoveries, 2);
    }

    #[test]
    fn a_stale_wall_stays_occupied_and_is_discovered_again_once_it_is_observed() {
        let mut map = Occupancy::new(&field());
        let wall = field().cell(Point { x: 5.1, y: 5.25 }).unwrap();
        scan(&mut map, 4.1, true);
        assert!(!map.is_stale(wall));
        map.mark_stale();
        assert!(map.is_stale(wall) && map.is_occupied(wall));
        assert_eq!((map.changes, map.discoveries), (1, 1));
        (0..3).for_each(|_| scan(&mut map, 4.1, true));
        assert!(!map.is_stale(wall));
        assert_eq!((map.changes, map.discoveries), (2, 2));
    }

    #[test]
    fn one_missing_return_does_not_clear_a_wall() {
        let mut map = Occupancy::new(&field());
        (0..3).for_each(|_| scan(&mut map, 4.1, true));
        scan(&mut map, 8.0, false);
        assert!(is_occupied(&map, 5.1));
    }

    #[test]
    fn rays_beyond_the_field_change_nothing() {
        let mut map = Occupancy::new(&field());
        scan(&mut map, 1e3, true);
        assert_eq!(map.changes, 0);
    }
}
