//! What is filled, as far as ranges tell.

use super::field::Field;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::{Point, Segment};
use core::ops::Range;

/// What a ray that ends in a cell says for its being filled, and one that passes, against it: steps
/// of a quarter of the natural logarithm of the odds.
const HIT: i8 = 4;
const PASS: i8 = -1;

/// More than this nobody is sure, so that what moves away is forgotten: odds of e^5.
const MOST: i8 = 20;

/// From here on a cell counts as filled: odds of e^1, 73%.
const FILLED: i8 = 4;

/// Cells of a field, each with the odds that it is filled.
///
/// After Moravec and Elfes, *High resolution maps from wide angle sonar*, ICRA 1985, with log odds:
/// each ray adds [`HIT`] to where it ends and [`PASS`] to where it passes. A byte a cell.
///
/// A wall seen at a small angle ends few rays, while many pass through cells that it fills in part. So a
/// ray passes only as far as its neighbours go too, and, as near as is told soon, no cell twice in a scan.
#[derive(Debug, Clone)]
pub(crate) struct Occupancy {
    quarter_nats: Vec<i8>,
    /// Cells that the ray before has passed, by their places along it.
    passed: Vec<usize>,
    /// Grows whenever a cell turns to be filled or free.
    pub(crate) changes: u32,
}

/// A ray as it was measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// From where it begins to where it, or one of its neighbours, ends.
    pub(crate) way: Segment,
    /// Where something stands.
    pub(crate) hit: Option<Point>,
}

impl Occupancy {
    pub(crate) fn new(field: &Field) -> Self {
        Self {
            quarter_nats: vec![0; field.cells()],
            passed: Vec::with_capacity(field.columns.max(field.rows) + 1),
            changes: 0,
        }
    }

    /// Whether a cell counts as filled.
    #[inline]
    pub(crate) fn is_filled(&self, cell: usize) -> bool {
        self.quarter_nats
            .get(cell)
            .is_some_and(|odds| *odds >= FILLED)
    }

    /// Whether any cell of some columns and rows counts as filled.
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
            cells.is_some_and(|cells| cells.iter().any(|odds| *odds >= FILLED))
        })
    }

    /// All cells that count as filled.
    pub(crate) fn filled(&self) -> impl Iterator<Item = usize> {
        let cells = self.quarter_nats.iter().enumerate();
        cells
            .filter(|(_, odds)| **odds >= FILLED)
            .map(|(cell, _)| cell)
    }

    /// How likely each cell is filled, in percent; -1 where nothing says either.
    pub(crate) fn percent(&self) -> impl Iterator<Item = i8> {
        let percents: [i8; 2 * MOST as usize + 1] = core::array::from_fn(percent);
        let place = |odds: i8| usize::from((odds + MOST).unsigned_abs());
        self.quarter_nats
            .iter()
            .map(move |odds| percents[place(*odds)])
    }

    /// Begins a scan, whose rays follow each other.
    pub(crate) fn begin_scan(&mut self) {
        self.passed.clear();
    }

    /// Takes in a ray of a scan.
    #[inline]
    pub(crate) fn take_in(&mut self, field: &Field, ray: &Ray) {
        let hit = ray.hit.and_then(|hit| field.cell(hit));
        for (place, cell) in field.crossed(ray.way.from, ray.way.to).enumerate() {
            let before = self.passed.get(place).copied();
            if before != Some(cell) && hit != Some(cell) {
                self.add(cell, PASS);
            }
            match self.passed.get_mut(place) {
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
            let was_filled = *odds >= FILLED;
            *odds = (*odds + change).clamp(-MOST, MOST);
            let is_changed = was_filled != (*odds >= FILLED);
            self.changes = self.changes.wrapping_add(u32::from(is_changed));
        }
    }

    /// Whether nothing hides a place from another, as far as is known: what fills the place itself, or stands
    /// so little before it, does not.
    pub(crate) fn sees(&self, field: &Field, from: Point, to: Point, blur_m: f64) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let most_m = length_m - field.cell_m - blur_m;
        most_m <= 0.0 || {
            let before = from.plus(way.times(most_m / length_m));
            self.is_free_between(field, from, before)
        }
    }

    /// Whether the straight way between two places is free as far as is known: it passes no filled cell,
    /// nor between two that touch at a corner.
    pub(crate) fn is_free_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let direction = way.times(1.0 / length_m.max(f64::MIN_POSITIVE));
        let mut last = field.cell(from);
        field.along(from, direction, length_m).all(|cell| {
            let before = last.replace(cell).unwrap_or(cell);
            !self.is_filled(cell) && !self.is_crack(field, before, cell)
        })
    }

    /// Whether two cells touch at a corner only, and both that lie beside it are filled.
    fn is_crack(&self, field: &Field, one: usize, other: usize) -> bool {
        let across = one.abs_diff(other).abs_diff(field.columns);
        across == 1 && {
            let [[left, low], [right, high]] =
                [one, other].map(|cell| field.column_and_row_of(cell));
            let is_filled = |column, row| {
                let cell = field.number(column, row);
                cell.is_some_and(|cell| self.is_filled(cell))
            };
            is_filled(left, high) && is_filled(right, low)
        }
    }
}

/// How likely a cell is filled whose odds are so many quarter nats above the least; -1 if they are even.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "0 to 100, of some forty"
)]
fn percent(above_least: usize) -> i8 {
    let nats = (above_least as f64 - f64::from(MOST)) / 4.0;
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

    fn look(map: &mut Occupancy, free_m: f64, is_hit: bool) {
        let way = Segment {
            from: Point { x: 1.0, y: 5.25 },
            to: Point {
                x: 1.0 + free_m,
                y: 5.25,
            },
        };
        map.begin_scan();
        let hit = is_hit.then_some(way.to);
        map.take_in(&field(), &Ray { way, hit });
    }

    fn is_filled(map: &Occupancy, x: f64) -> bool {
        map.is_filled(field().cell(Point { x, y: 5.25 }).unwrap())
    }

    #[test]
    fn a_wall_is_filled_and_what_is_before_it_free() {
        let mut map = Occupancy::new(&field());
        look(&mut map, 4.1, true);
        assert!(is_filled(&map, 5.1) && map.changes == 1);
        assert!((2..10).all(|half| !is_filled(&map, 0.1 + 0.5 * f64::from(half))));
        let (near, far) = (Point { x: 1.0, y: 5.25 }, Point { x: 9.0, y: 5.25 });
        assert!(!map.is_free_between(&field(), near, far));
        assert!(map.is_free_between(&field(), near, Point { x: 4.9, y: 5.25 }));
    }

    #[test]
    fn what_has_gone_is_forgotten_in_some_looks() {
        let mut map = Occupancy::new(&field());
        (0..100).for_each(|_| look(&mut map, 4.1, true));
        let looks = (0..).take_while(|_| {
            look(&mut map, 8.0, false);
            is_filled(&map, 5.1)
        });
        assert!((10..20).contains(&looks.count()));
    }

    #[test]
    fn one_lost_echo_opens_no_wall() {
        let mut map = Occupancy::new(&field());
        (0..3).for_each(|_| look(&mut map, 4.1, true));
        look(&mut map, 8.0, false);
        assert!(is_filled(&map, 5.1));
    }

    #[test]
    fn what_is_beyond_the_field_is_left_alone() {
        let mut map = Occupancy::new(&field());
        look(&mut map, 1e3, true);
        assert_eq!(map.changes, 0);
    }
}
