//! What a look from a place promises.

use crate::beliefs::Map;
use crate::beliefs::unseen::{SUREST, View};
use crate::body::Detector;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::TAU;

/// Courses that are told apart: between two, a view of 60 degrees shifts by less than a fifth of itself.
const COURSES: u16 = 16;

/// No detector is so bad that it would need more than some hundred looks.
const LEAST_SEEN: f64 = 0.01;

/// The cells that a body's detectors see from the middle of one, for each course.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outlook {
    /// Columns to the right and rows up, and how likely a look there sees what is there; course by course.
    cells: Vec<([i32; 2], f64)>,
    /// Where each course ends.
    ends: Vec<usize>,
    /// Most that any course promises.
    pub(crate) most: f64,
    needs_line_of_sight: bool,
}

impl Outlook {
    /// That of a body on a map.
    pub(crate) fn new(detectors: &[Detector], map: &Map) -> Self {
        let mut outlook = Self {
            needs_line_of_sight: detectors.iter().any(|one| one.needs_line_of_sight),
            ..Self::default()
        };
        for course in 0..COURSES {
            let first = outlook.cells.len();
            for detector in detectors {
                outlook.add(detector, f64::from(course) * TAU / f64::from(COURSES), map);
            }
            if outlook.cells.len() == first {
                // It sees less than a cell: at least the one where it is.
                let seen = detectors.iter().map(|one| one.least_probability(0.0));
                outlook.cells.push(([0, 0], seen.fold(0.0, f64::max)));
            }
            outlook.ends.push(outlook.cells.len());
            let all = outlook.cells[first..].iter().map(|(_, seen)| seen).sum();
            outlook.most = outlook.most.max(all);
        }
        outlook
    }

    /// Adds what a detector sees on a course.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "at most some thousands"
    )]
    fn add(&mut self, detector: &Detector, course_rad: f64, map: &Map) {
        let field = &map.field;
        let view = View::new(detector, course_rad);
        let across = field.columns.max(field.rows) as i32;
        let reach = (libm::ceil(detector.range_m / field.cell_m) as i32).min(across);
        for up in -reach..=reach {
            for right in -reach..=reach {
                let way = Point::from([f64::from(right), f64::from(up)]).times(field.cell_m);
                if view.holds_cell(field, way) {
                    let seen = detector.least_probability(way.length());
                    self.cells.push(([right, up], seen));
                }
            }
        }
    }

    /// So many looks miss e^-`nats` of what is in view.
    pub(crate) fn looks(&self, nats: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "some thousands")]
        let count = self.cells.len().max(1) as f64;
        let seen = self.cells.iter().map(|(_, seen)| seen).sum::<f64>() / count;
        nats / -libm::log1p(-seen.clamp(LEAST_SEEN, SUREST))
    }

    /// What is seen on the way to somewhere, from there on.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few courses"
    )]
    fn seen(&self, way: Point) -> &[([i32; 2], f64)] {
        let turns = libm::atan2(way.y, way.x) / TAU;
        let course =
            libm::round((turns + 1.0) * f64::from(COURSES)) as usize % usize::from(COURSES);
        let end = |course: usize| self.ends.get(course).copied().unwrap_or_default();
        let first = course.checked_sub(1).map_or(0, end);
        self.cells.get(first..end(course)).unwrap_or_default()
    }

    /// How many items a look from a cell would find at the end of a way there, if there were one unseen
    /// in each cell, unless something hides them.
    pub(crate) fn at_best(&self, map: &Map, cell: usize, way: Point) -> f64 {
        self.sum(map, cell, way, |_| true)
    }

    /// The same of what nothing hides.
    pub(crate) fn promises(&self, map: &Map, cell: usize, way: Point, blur_m: f64) -> f64 {
        let at = map.field.centre(cell);
        self.sum(map, cell, way, |seen| {
            let place = map.field.centre(seen);
            !self.needs_line_of_sight || map.filled.sees(&map.field, at, place, blur_m)
        })
    }

    #[inline]
    fn sum(&self, map: &Map, cell: usize, way: Point, counts: impl Fn(usize) -> bool) -> f64 {
        let [column, row] = map.field.column_and_row_of(cell);
        let cells = self.seen(way).iter().filter_map(|([right, up], seen)| {
            let cell = map.field.number(column + right, row + up)?;
            counts(cell).then(|| seen * map.unseen.of(cell))
        });
        cells.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beliefs::BeliefsSpec;
    use crate::beliefs::occupancy::Ray;
    use crate::beliefs::unseen::Glance;
    use crate::beliefs::unseen::tests::{detector, map};
    use base::geometry::{Rectangle, Segment};

    const HERE: Point = Point { x: 10.1, y: 10.1 };
    const AHEAD: Point = Point { x: 1.0, y: 0.0 };

    fn eye() -> Detector {
        Detector {
            needs_line_of_sight: true,
            ..detector(3.0, 1.2, 1.0)
        }
    }

    fn glance(eye: &Detector) -> Glance<'_> {
        Glance {
            detector: eye,
            at: HERE,
            heading_rad: 0.0,
            trust: 1.0,
            looks: 1.0,
            blur_m: 0.0,
        }
    }

    fn promises(map: &Map, way: Point, blur_m: f64) -> f64 {
        let cell = map.field.nearest_cell(HERE);
        Outlook::new(&[eye()], map).promises(map, cell, way, blur_m)
    }

    #[test]
    fn a_look_promises_what_nobody_has_seen_the_way_that_it_faces() {
        let (mut map, eye) = (map(), eye());
        let [ahead, back] = [AHEAD, AHEAD.times(-1.0)];
        let [before, behind] = [ahead, back].map(|way| promises(&map, way, 0.0));
        assert!(before > 10.0);
        map.unseen.take_in(&map.field, &map.filled, &glance(&eye));
        assert!(promises(&map, ahead, 0.0) < 0.5 * before);
        assert!((promises(&map, back, 0.0) - behind).abs() < 1e-9);
    }

    #[test]
    fn what_stands_hides_what_is_behind_it_as_far_as_the_map_is_sure() {
        let mut map = map();
        let open = promises(&map, AHEAD, 0.0);
        for y in 0..30 {
            let to = Point {
                x: 11.1,
                y: 8.0 + 0.15 * f64::from(y),
            };
            let ray = Ray {
                way: Segment { from: HERE, to },
                is_hit: true,
            };
            (0..5).for_each(|_| map.filled.take_in(&map.field, &ray));
        }
        let [sure, unsure] = [0.0, 0.5].map(|blur_m| promises(&map, AHEAD, blur_m));
        assert!(
            sure < 0.5 * open && sure < unsure && unsure < open,
            "{sure} {unsure} {open}"
        );
    }

    #[test]
    fn the_worse_a_detector_is_the_more_looks_a_place_takes() {
        let looks = |seen: f64| Outlook::new(&[detector(3.0, 1.2, seen)], &map()).looks(2.0);
        assert!((looks(0.3) - 5.6).abs() < 0.1 && (looks(0.1) - 19.0).abs() < 0.1);
        assert!(looks(1.0) < 2.0 && looks(0.0) < 200.0);
    }

    #[test]
    fn whoever_sees_less_than_a_cell_is_promised_the_one_where_he_is() {
        let corner = Point { x: 500.0, y: 500.0 };
        let area = Rectangle::spanned(Point::default(), corner);
        let map = Map::new(&BeliefsSpec::default(), &area);
        assert!(promises(&map, AHEAD, 0.0) > 0.9);
    }
}
