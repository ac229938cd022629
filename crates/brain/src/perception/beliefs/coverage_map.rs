//! Where an item could still be that nobody has seen.

use super::field::Field;
use super::occupancy::Occupancy;
use crate::io::body::Detector;
use crate::perception::sector::direction;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::{PI, TAU};

/// For each cell, the probability that all observations so far would have missed an item there.
///
/// Each look at a cell multiplies it by 1 - p, with the detector's own p at that distance (Koopman,
/// *Search and screening*, 1946). If items are anywhere with the same density, an unseen one is in a
/// cell with a probability in proportion to this. Four bytes a cell.
///
/// Looks that others tell of were taken with the probability that they are trusted, else they tell nothing:
///
/// ```text
/// missed = 1 - trust (1 - (1 - p)^observations)
/// ```
///
/// over all messages together: each takes away of what is left above 1 - trust, and what is below it stays.
/// So nobody is believed more than he is trusted, however often he says it.
#[derive(Debug, Clone)]
pub(crate) struct CoverageMap {
    missed: Vec<f32>,
}

impl CoverageMap {
    pub(crate) fn new(cells: usize) -> Self {
        Self {
            missed: vec![1.0; cells],
        }
    }

    /// Probability that an item in a cell has not been seen, 0 to 1; 0 outside the field.
    #[inline]
    pub(crate) fn of(&self, cell: usize) -> f64 {
        self.missed.get(cell).copied().unwrap_or_default().into()
    }
}

impl CoverageMap {
    /// The same of all cells, in percent.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 100"
    )]
    pub(crate) fn percent(&self) -> impl Iterator<Item = u8> {
        // What is left of an item is not nothing.
        self.missed
            .iter()
            .map(|missed| libm::ceilf(100.0 * missed) as u8)
    }

    /// The same of all cells in a row of the field.
    #[inline]
    pub(crate) fn row(&self, field: &Field, row: usize) -> &[f32] {
        &self.missed[row * field.columns..(row + 1) * field.columns]
    }
}

/// A cell is looked at if its centre is so far within what is seen, as a share of its width: most of it is
/// seen then.
const MARGIN: f64 = 0.35;

/// That in metres; what sees less than two cells far sees as if they were smaller.
fn margin_m(field: &Field, range_m: f64) -> f64 {
    MARGIN * field.cell_m.min(range_m / 2.0)
}

/// No look is surer than this to see what is there: what is said of detectors errs, and where it observations from.
/// So who has looked at all goes on, first where there were fewest observations.
pub(crate) const SUREST: f64 = 0.8;

/// No cell is emptier than this, after some fifty sure observations: more are not told apart, and no smaller number
/// is as fast to reckon with.
const LEAST: f32 = 1e-36;

/// A look for items, by whomever.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Glance<'g> {
    pub(crate) detector: &'g Detector,
    pub(crate) at: Point,
    pub(crate) heading_rad: f64,
    /// How far its giver is trusted, 0 to 1.
    pub(crate) trust: f64,
    /// It counts as so many observations.
    pub(crate) observations: f64,
    /// What is no farther behind something than this is not hidden for sure.
    pub(crate) blur_m: f64,
}

impl CoverageMap {
    /// Takes in that a look saw nothing new.
    pub(crate) fn take_in(&mut self, field: &Field, filled: &Occupancy, glance: &Glance) {
        let Glance {
            detector,
            at,
            heading_rad,
            trust,
            observations,
            blur_m,
        } = *glance;
        let view = View::new(detector, heading_rad);
        let (low, high) = view.box_about(at);
        let margin_m = margin_m(field, detector.range_m);
        let [columns, rows] = field.columns_and_rows(low, high);
        let may_hide = detector.needs_line_of_sight && filled.is_any_in(field, &columns, &rows);
        let floor = untold(trust);
        let least = floor.max(LEAST);
        for row in rows {
            for cell in row * field.columns + columns.start..row * field.columns + columns.end {
                if self.missed[cell] <= least {
                    continue;
                }
                let place = field.centre(cell);
                let way = at.to(place);
                let is_in_view = view.holds_within(way, margin_m);
                if is_in_view && (!may_hide || filled.sees(field, at, place, blur_m)) {
                    let seen = detector.least_probability(way.length());
                    let above = self.missed[cell] - floor;
                    self.missed[cell] = floor + above * missed(seen, observations);
                }
            }
        }
    }
}

/// Probability that observations were not taken that are trusted so much.
#[expect(clippy::cast_possible_truncation, reason = "kept short")]
fn untold(trust: f64) -> f32 {
    (1.0 - trust).clamp(0.0, 1.0) as f32
}

/// Probability that so many observations miss what each sees with a probability.
#[expect(clippy::cast_possible_truncation, reason = "kept short")]
fn missed(seen: f64, observations: f64) -> f32 {
    let left = 1.0 - seen.min(SUREST);
    if observations <= 1.0 {
        left as f32
    } else {
        libm::pow(left, observations) as f32
    }
}

/// What a detector observations at, in the world.
pub(crate) struct View {
    range_m: f64,
    /// The directions of its right and its left edge.
    edges: [Point; 2],
    width: Width,
}

enum Width {
    /// At most half of all directions.
    Narrow,
    Wide,
    Round,
}

impl View {
    pub(crate) fn new(detector: &Detector, heading_rad: f64) -> Self {
        let facing_rad = heading_rad + detector.facing_rad;
        let half_rad = detector.width_rad / 2.0;
        Self {
            range_m: detector.range_m,
            edges: [facing_rad - half_rad, facing_rad + half_rad].map(direction),
            width: match detector.width_rad {
                width_rad if width_rad >= TAU => Width::Round,
                width_rad if width_rad > PI => Width::Wide,
                _ => Width::Narrow,
            },
        }
    }

    /// The corners of a box that holds all that it sees from a place.
    fn box_about(&self, at: Point) -> (Point, Point) {
        let ends = self.edges.map(|edge| edge.times(self.range_m));
        let is_narrow = matches!(self.width, Width::Narrow);
        let reach_m = |x: f64, y: f64, of: fn(Point) -> f64| {
            let axis = Point { x, y }.times(self.range_m);
            if !is_narrow || self.holds(axis) {
                self.range_m
            } else {
                let [one, other] = ends.map(|end| of(end) * (x + y));
                one.max(other).max(0.0)
            }
        };
        let low = Point {
            x: reach_m(-1.0, 0.0, |end| end.x),
            y: reach_m(0.0, -1.0, |end| end.y),
        };
        let high = Point {
            x: reach_m(1.0, 0.0, |end| end.x),
            y: reach_m(0.0, 1.0, |end| end.y),
        };
        (low.to(at), at.plus(high))
    }

    /// Whether it sees the end of a way.
    #[inline]
    pub(crate) fn holds(&self, way: Point) -> bool {
        self.holds_within(way, 0.0)
    }

    /// Whether most of the cell at the end of a way is seen.
    pub(crate) fn holds_cell(&self, field: &Field, way: Point) -> bool {
        self.holds_within(way, margin_m(field, self.range_m))
    }

    /// The same so far within its edges.
    #[inline]
    fn holds_within(&self, way: Point, margin_m: f64) -> bool {
        let most_m = self.range_m - margin_m;
        let [right, left] = self.edges;
        let is_left = right.cross(way) >= margin_m;
        let is_right = way.cross(left) >= margin_m;
        let is_between = match self.width {
            Width::Narrow => is_left && is_right,
            Width::Wide => is_left || is_right,
            Width::Round => true,
        };
        is_between && most_m > 0.0 && way.length_squared() <= most_m * most_m
    }
}

impl Detector {
    /// Probability that one look recognises an item of a kind at a distance.
    pub(crate) fn probability(&self, kind: usize, distance_m: f64) -> f64 {
        let pairs = self
            .detection_probability
            .get(kind)
            .map_or(&[][..], Vec::as_slice);
        let next = pairs.partition_point(|[at_m, _]| *at_m <= distance_m);
        let last = next.checked_sub(1).and_then(|last| pairs.get(last));
        match (last, pairs.get(next)) {
            (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (distance_m - x0) / (x1 - x0),
            (Some([_, y]), None) | (None, Some([_, y])) => *y,
            (None, None) => 0.0,
        }
    }

    /// The least of all kinds that it recognises at all: who has seen those has seen the others.
    pub(crate) fn least_probability(&self, distance_m: f64) -> f64 {
        let kinds = (0..self.detection_probability.len())
            .filter(|kind| !self.detection_probability[*kind].is_empty());
        let least = kinds
            .map(|kind| self.probability(kind, distance_m))
            .fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::perception::beliefs::{BeliefsSpec, Map};
    use base::geometry::Rectangle;
    use proptest::prelude::*;

    /// A detector with a probability, all around or ahead.
    pub(crate) fn detector(range_m: f64, width_rad: f64, probability: f64) -> Detector {
        Detector {
            range_m,
            width_rad,
            detection_probability: vec![vec![[0.0, probability]]],
            false_alarms_per_m2: vec![0.0],
            ..Detector::default()
        }
    }

    pub(crate) fn map() -> Map {
        let corner = Point { x: 20.0, y: 20.0 };
        let area = Rectangle::spanned(Point::default(), corner);
        Map::new(&BeliefsSpec::default(), &area)
    }

    fn seen(map: &Map, unseen: &CoverageMap, x: f64, y: f64) -> f64 {
        1.0 - unseen.of(map.field.cell(Point { x, y }).unwrap())
    }

    fn look(unseen: &mut CoverageMap, map: &Map, detector: &Detector, x: f64, trust: f64) {
        let glance = Glance {
            detector,
            at: Point { x, y: 10.0 },
            heading_rad: 0.0,
            trust,
            observations: 1.0,
            blur_m: 0.0,
        };
        unseen.take_in(&map.field, &map.filled, &glance);
    }

    proptest! {
        #[test]
        fn all_that_a_view_holds_is_in_its_box(
            width_rad in 0.1_f64..7.0, heading_rad in -4.0_f64..4.0,
            way in (-3.0_f64..3.0, -3.0_f64..3.0), at in (-9.0_f64..9.0, -9.0_f64..9.0),
        ) {
            let view = View::new(&detector(3.0, width_rad, 1.0), heading_rad);
            let (way, at) = (Point::from([way.0, way.1]), Point::from([at.0, at.1]));
            let ((low, high), place) = (view.box_about(at), at.plus(way));
            let is_in = low.x <= place.x && place.x <= high.x && low.y <= place.y && place.y <= high.y;
            prop_assert!(is_in || !view.holds(way));
        }
    }

    #[test]
    fn two_looks_of_one_half_miss_a_quarter() {
        let (map, eye) = (map(), detector(3.0, 7.0, 0.5));
        let mut unseen = CoverageMap::new(map.field.cells());
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        assert!((seen(&map, &unseen, 11.0, 11.0) - 0.75).abs() < 1e-6);
        assert!(seen(&map, &unseen, 14.0, 10.0) < 1e-9);
    }

    #[test]
    fn what_looks_ahead_does_not_see_behind() {
        let (map, eye) = (map(), detector(3.0, 1.2, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        assert!(seen(&map, &unseen, 12.0, 10.0) > SUREST - 1e-6);
        assert!(seen(&map, &unseen, 8.0, 10.0) < 1e-9 && seen(&map, &unseen, 10.0, 12.0) < 1e-9);
    }

    #[test]
    fn however_sure_a_look_is_said_to_be_it_leaves_something_and_a_second_leaves_less() {
        let (map, eye) = (map(), detector(3.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        let mut before = 1.0;
        for _ in 0..20 {
            look(&mut unseen, &map, &eye, 10.0, 1.0);
            let left = unseen.of(map.field.nearest_cell(Point { x: 11.0, y: 10.0 }));
            assert!(0.0 < left && left < 0.21 * before);
            before = left;
        }
    }

    /// The thesis's example: own range 2, a sender 5 away with range 2, and full confidence.
    #[test]
    fn a_report_extends_the_picture_towards_its_sender_and_nowhere_else() {
        let (map, eye) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        look(&mut unseen, &map, &eye, 8.0, 1.0);
        look(&mut unseen, &map, &eye, 13.0, 1.0);
        for x in [6.2, 9.8, 11.2, 14.8] {
            assert!(seen(&map, &unseen, x, 10.0) > SUREST - 1e-6, "{x}");
        }
        // A full disc of 5 is not gained.
        for (x, y) in [(8.0, 14.0), (8.0, 6.0), (4.0, 10.0), (10.5, 12.0)] {
            assert!(seen(&map, &unseen, x, y) < 1e-9, "{x} {y}");
        }
    }

    #[test]
    fn a_report_counts_as_much_as_its_sender_is_trusted() {
        let (map, eye) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        look(&mut unseen, &map, &eye, 13.0, 0.4);
        assert!((seen(&map, &unseen, 13.0, 11.0) - 0.4 * SUREST).abs() < 1e-6);
    }

    #[test]
    fn however_often_looks_are_told_of_they_count_no_more_than_they_are_trusted() {
        let (map, eye) = (map(), detector(2.0, 7.0, 0.5));
        for trust in [0.05, 0.5, 0.9] {
            let mut unseen = CoverageMap::new(map.field.cells());
            for observations in 1..100 {
                look(&mut unseen, &map, &eye, 13.0, trust);
                let expected = trust * (1.0 - libm::pow(0.5, f64::from(observations)));
                assert!((seen(&map, &unseen, 13.0, 11.0) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn what_others_tell_takes_nothing_back_of_what_own_looks_say() {
        let (map, eye) = (map(), detector(2.0, 7.0, 0.8));
        let mut unseen = CoverageMap::new(map.field.cells());
        (0..3).for_each(|_| look(&mut unseen, &map, &eye, 13.0, 1.0));
        let before = seen(&map, &unseen, 13.0, 11.0);
        look(&mut unseen, &map, &eye, 13.0, 0.5);
        assert!((seen(&map, &unseen, 13.0, 11.0) - before).abs() < 1e-9);
    }

    #[test]
    fn a_detection_table_is_linear_between_its_pairs() {
        let mut eye = detector(3.0, 7.0, 1.0);
        eye.detection_probability = vec![vec![[1.0, 0.9], [3.0, 0.1]], vec![]];
        for (distance_m, expected) in [(0.0, 0.9), (2.0, 0.5), (5.0, 0.1)] {
            assert!((eye.probability(0, distance_m) - expected).abs() < 1e-12);
        }
        assert!(eye.probability(1, 1.0) < 1e-9 && eye.probability(9, 1.0) < 1e-9);
        assert!((eye.least_probability(2.0) - 0.5).abs() < 1e-12);
    }
}
