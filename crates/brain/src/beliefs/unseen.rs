//! Where an item could still be that nobody has seen.

use super::field::Field;
use super::occupancy::Occupancy;
use crate::body::Detector;
use crate::sector::direction;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::TAU;

/// For each cell, the probability that all looks so far would have missed an item there.
///
/// Each look at a cell multiplies it by 1 - p, with the detector's own p at that distance (Koopman,
/// *Search and screening*, 1946). If items are anywhere with the same density, an unseen one is in a
/// cell with a probability in proportion to this. Four bytes a cell.
#[derive(Debug, Clone)]
pub(crate) struct Unseen {
    missed: Vec<f32>,
}

impl Unseen {
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

/// A look for items, by whomever.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Glance<'g> {
    pub(crate) detector: &'g Detector,
    pub(crate) at: Point,
    pub(crate) heading_rad: f64,
    /// How far its giver is trusted, 0 to 1.
    pub(crate) trust: f64,
    /// It counts as so many looks.
    pub(crate) looks: f64,
}

impl Unseen {
    /// Takes in that a look saw nothing new.
    pub(crate) fn take_in(&mut self, field: &Field, filled: &Occupancy, glance: &Glance) {
        let Glance {
            detector,
            at,
            heading_rad,
            trust,
            looks,
        } = *glance;
        let view = View::new(detector, heading_rad);
        for cell in field.about(at, detector.range_m) {
            let place = field.centre(cell);
            let way = at.to(place);
            if !view.holds(way) || self.missed[cell] == 0.0 {
                continue;
            }
            let hidden = detector.needs_line_of_sight && !filled.sees(field, at, place);
            if !hidden {
                let seen = trust * detector.least_probability(way.length());
                let left = (1.0 - seen).max(0.0);
                #[expect(clippy::cast_possible_truncation, reason = "kept short")]
                let left = if looks <= 1.0 {
                    left
                } else {
                    libm::pow(left, looks)
                } as f32;
                self.missed[cell] *= left;
            }
        }
    }
}

/// What a detector looks at, in the world.
pub(crate) struct View {
    range_m: f64,
    facing: Point,
    /// Cosine of half its width; below -1 if it looks all around.
    edge: f64,
}

impl View {
    pub(crate) fn new(detector: &Detector, heading_rad: f64) -> Self {
        let is_round = detector.width_rad >= TAU;
        Self {
            range_m: detector.range_m,
            facing: direction(heading_rad + detector.facing_rad),
            edge: if is_round {
                -2.0
            } else {
                direction(detector.width_rad / 2.0).x
            },
        }
    }

    #[inline]
    pub(crate) fn holds(&self, way: Point) -> bool {
        let square = way.length_squared();
        square <= self.range_m * self.range_m
            && self.facing.dot(way) >= self.edge * libm::sqrt(square)
    }
}

impl Detector {
    /// Probability that one look recognises an item of a kind at a distance.
    pub(crate) fn probability(&self, kind: usize, distance_m: f64) -> f64 {
        let pairs = self.detects.get(kind).map_or(&[][..], Vec::as_slice);
        let next = pairs.partition_point(|[at_m, _]| *at_m <= distance_m);
        let last = next.checked_sub(1).and_then(|last| pairs.get(last));
        match (last, pairs.get(next)) {
            (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (distance_m - x0) / (x1 - x0),
            (Some([_, y]), None) | (None, Some([_, y])) => *y,
            (None, None) => 0.0,
        }
    }

    /// The least of all kinds that it recognises at all: who has seen those has seen the others.
    fn least_probability(&self, distance_m: f64) -> f64 {
        let kinds = (0..self.detects.len()).filter(|kind| !self.detects[*kind].is_empty());
        let least = kinds
            .map(|kind| self.probability(kind, distance_m))
            .fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::beliefs::{BeliefsSpec, Map};
    use base::geometry::Rectangle;

    /// A detector with a probability, all around or ahead.
    pub(crate) fn detector(range_m: f64, width_rad: f64, probability: f64) -> Detector {
        Detector {
            range_m,
            width_rad,
            detects: vec![vec![[0.0, probability]]],
            false_alarms_per_m2: vec![0.0],
            ..Detector::default()
        }
    }

    pub(crate) fn map() -> Map {
        let corner = Point { x: 20.0, y: 20.0 };
        let area = Rectangle::spanned(Point::default(), corner);
        Map::new(&BeliefsSpec::default(), &area)
    }

    fn seen(map: &Map, unseen: &Unseen, x: f64, y: f64) -> f64 {
        1.0 - unseen.of(map.field.cell(Point { x, y }).unwrap())
    }

    fn look(unseen: &mut Unseen, map: &Map, detector: &Detector, x: f64, trust: f64) {
        let glance = Glance {
            detector,
            at: Point { x, y: 10.0 },
            heading_rad: 0.0,
            trust,
            looks: 1.0,
        };
        unseen.take_in(&map.field, &map.filled, &glance);
    }

    #[test]
    fn two_looks_of_one_half_miss_a_quarter() {
        let (map, eye) = (map(), detector(3.0, 7.0, 0.5));
        let mut unseen = Unseen::new(map.field.cells());
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        assert!((seen(&map, &unseen, 11.0, 11.0) - 0.75).abs() < 1e-6);
        assert!(seen(&map, &unseen, 14.0, 10.0) < 1e-9);
    }

    #[test]
    fn what_looks_ahead_does_not_see_behind() {
        let (map, eye) = (map(), detector(3.0, 1.2, 1.0));
        let mut unseen = Unseen::new(map.field.cells());
        look(&mut unseen, &map, &eye, 10.0, 1.0);
        assert!(seen(&map, &unseen, 12.0, 10.0) > 0.999);
        assert!(seen(&map, &unseen, 8.0, 10.0) < 1e-9 && seen(&map, &unseen, 10.0, 12.0) < 1e-9);
    }

    /// The thesis's example: own range 2, a sender 5 away with range 2, and full confidence.
    #[test]
    fn a_report_extends_the_picture_towards_its_sender_and_nowhere_else() {
        let (map, eye) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = Unseen::new(map.field.cells());
        look(&mut unseen, &map, &eye, 8.0, 1.0);
        look(&mut unseen, &map, &eye, 13.0, 1.0);
        for x in [6.2, 9.8, 11.2, 14.8] {
            assert!(seen(&map, &unseen, x, 10.0) > 0.999, "{x}");
        }
        // A full disc of 5 is not gained.
        for (x, y) in [(8.0, 14.0), (8.0, 6.0), (4.0, 10.0), (10.5, 12.0)] {
            assert!(seen(&map, &unseen, x, y) < 1e-9, "{x} {y}");
        }
    }

    #[test]
    fn a_report_counts_as_much_as_its_sender_is_trusted() {
        let (map, eye) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = Unseen::new(map.field.cells());
        look(&mut unseen, &map, &eye, 13.0, 0.4);
        assert!((seen(&map, &unseen, 13.0, 11.0) - 0.4).abs() < 1e-6);
    }

    #[test]
    fn a_detection_table_is_linear_between_its_pairs() {
        let mut eye = detector(3.0, 7.0, 1.0);
        eye.detects = vec![vec![[1.0, 0.9], [3.0, 0.1]], vec![]];
        for (distance_m, expected) in [(0.0, 0.9), (2.0, 0.5), (5.0, 0.1)] {
            assert!((eye.probability(0, distance_m) - expected).abs() < 1e-12);
        }
        assert!(eye.probability(1, 1.0) < 1e-9 && eye.probability(9, 1.0) < 1e-9);
        assert!((eye.least_probability(2.0) - 0.5).abs() < 1e-12);
    }
}
