//! What is filled, as far as ranges tell.

use super::field::Field;
use super::pose::Pose;
use crate::sector::direction;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;

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
#[derive(Debug, Clone)]
pub(crate) struct Occupancy {
    quarter_nats: Vec<i8>,
    /// Grows whenever a cell turns to be filled or free.
    pub(crate) changes: u32,
}

/// A ray as it was measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// From the robot's front.
    pub(crate) bearing_rad: f64,
    /// As far as it is free.
    pub(crate) free_m: f64,
    /// Whether something stands there.
    pub(crate) is_hit: bool,
}

impl Occupancy {
    pub(crate) fn new(field: &Field) -> Self {
        Self {
            quarter_nats: vec![0; field.cells()],
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

    /// Takes in a ray that was measured at a pose.
    pub(crate) fn take_in(&mut self, field: &Field, pose: &Pose, ray: Ray) {
        let way = direction(pose.heading_rad + ray.bearing_rad);
        let end = field.cell(pose.at.plus(way.times(ray.free_m)));
        let hit = end.filter(|_| ray.is_hit);
        // Half a cell apart, no cell that matters is left out, and none counts twice in a row.
        let mut last = hit;
        for cell in passed(field, pose.at, way, ray.free_m) {
            if Some(cell) != last && Some(cell) != hit {
                self.add(cell, PASS);
            }
            last = Some(cell);
        }
        if let Some(cell) = hit {
            self.add(cell, HIT);
        }
    }

    #[inline]
    fn add(&mut self, cell: usize, change: i8) {
        if let Some(odds) = self.quarter_nats.get_mut(cell) {
            let was_filled = *odds >= FILLED;
            *odds = odds.saturating_add(change).clamp(-MOST, MOST);
            self.changes = self
                .changes
                .wrapping_add(u32::from(was_filled != (*odds >= FILLED)));
        }
    }

    /// Whether nothing hides a place from another, as far as is known: what fills the place itself
    /// does not.
    pub(crate) fn sees(&self, field: &Field, from: Point, to: Point) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let most_m = length_m - field.cell_m;
        most_m <= 0.0 || {
            let before = from.plus(way.times(most_m / length_m));
            self.is_free_between(field, from, before)
        }
    }

    /// Whether the straight way between two places is free as far as is known.
    pub(crate) fn is_free_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let direction = way.times(1.0 / length_m.max(f64::MIN_POSITIVE));
        !passed(field, from, direction, length_m).any(|cell| self.is_filled(cell))
    }
}

/// Cells on the way from a place along a direction of length 1, half a cell apart; those outside are
/// left out.
#[inline]
fn passed(field: &Field, from: Point, way: Point, length_m: f64) -> impl Iterator<Item = usize> {
    let [mut right, mut up] = field.in_cells(from);
    let (columns, rows) = (field.columns, field.rows);
    let count = 2.0 * length_m / field.cell_m;
    // Nobody sees farther than all cells.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast saturates"
    )]
    let count = (count as usize).min(4 * (columns + rows));
    (0..count).filter_map(move |_| {
        right += way.x / 2.0;
        up += way.y / 2.0;
        if right < 0.0 || up < 0.0 {
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a cast saturates"
        )]
        let (column, row) = (right as usize, up as usize);
        (column < columns && row < rows).then_some(row * columns + column)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::geometry::Rectangle;

    fn field() -> Field {
        let corner = Point { x: 10.0, y: 10.0 };
        Field::new(&Rectangle::spanned(Point::default(), corner), 0.5, 10_000)
    }

    fn pose(x: f64, y: f64) -> Pose {
        Pose {
            at: Point { x, y },
            heading_rad: 0.0,
            deviation_m: 0.0,
            deviation_rad: 0.0,
            age_s: 0.0,
        }
    }

    fn look(map: &mut Occupancy, free_m: f64, is_hit: bool) {
        let ray = Ray {
            bearing_rad: 0.0,
            free_m,
            is_hit,
        };
        map.take_in(&field(), &pose(1.0, 5.25), ray);
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
        let (near, far) = (pose(1.0, 5.25).at, Point { x: 9.0, y: 5.25 });
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
