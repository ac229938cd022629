//! The coverage map: where an undetected item could still be.

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
/// Each observation of a cell multiplies it by 1 - p, where p is the detector's probability of detection at
/// that distance (Koopman, *Search and screening*, 1946). If items are distributed uniformly, the probability
/// that an undetected item is in a cell is proportional to this value. Four bytes per cell.
///
/// Reported observations are valid with the probability given by the trust in their sender, and carry no
/// information otherwise:
///
/// ```text
/// missed = 1 - trust (1 - (1 - p)^observations)
/// ```
///
/// This holds for all messages together: each reduces only the part above 1 - trust, and values below that
/// stay. A robot is therefore never believed more than it is trusted, however often it repeats a report.
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

    /// Probability that an item in a cell was not detected, 0 to 1; 0 outside the field.
    #[inline]
    pub(crate) fn of(&self, cell: usize) -> f64 {
        self.missed.get(cell).copied().unwrap_or_default().into()
    }
}

impl CoverageMap {
    /// The values of all cells, in percent.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 100"
    )]
    pub(crate) fn percent(&self) -> impl Iterator<Item = u8> {
        // Rounded up: 0 only if nothing remains.
        self.missed
            .iter()
            .map(|missed| libm::ceilf(100.0 * missed) as u8)
    }

    /// The values of a row of the field.
    #[inline]
    pub(crate) fn row(&self, field: &Field, row: usize) -> &[f32] {
        &self.missed[row * field.columns..(row + 1) * field.columns]
    }
}

/// A cell counts as observed if its centre is inside the field of view by this fraction of its width: most of
/// the cell is in view then.
const MARGIN: f64 = 0.35;

/// The margin in metres; it is smaller for detectors with a range below two cells.
fn margin_m(field: &Field, range_m: f64) -> f64 {
    MARGIN * field.cell_m.min(range_m / 2.0)
}

/// Maximum probability of detection of one observation: detector models and poses have errors. A robot that
/// has observed everything therefore continues, first where there were the fewest observations.
pub(crate) const MAX_DETECTION: f64 = 0.8;

/// Minimum value of a cell, reached after about fifty observations; smaller numbers would be denormal, which
/// are slow.
const MIN_MISSED: f32 = 1e-36;

/// One or more observations of an item detector, by this robot or another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DetectorScan<'g> {
    pub(crate) detector: &'g Detector,
    pub(crate) at: Point,
    pub(crate) heading_rad: f64,
    /// Trust in the observer, 0 to 1.
    pub(crate) trust: f64,
    /// Number of observations.
    pub(crate) observations: f64,
    /// Cells that are no farther behind an obstacle than this count as visible.
    pub(crate) blur_m: f64,
}

impl CoverageMap {
    /// Updates all cells in view.
    pub(crate) fn update(&mut self, field: &Field, occupancy: &Occupancy, scan: &DetectorScan) {
        let DetectorScan {
            detector,
            at,
            heading_rad,
            trust,
            observations,
            blur_m,
        } = *scan;
        let view = View::new(detector, heading_rad);
        let (low, high) = view.box_about(at);
        let margin_m = margin_m(field, detector.range_m);
        let [columns, rows] = field.columns_and_rows(low, high);
        let may_be_hidden =
            detector.needs_line_of_sight && occupancy.is_any_in(field, &columns, &rows);
        let floor = distrusted(trust);
        let min = floor.max(MIN_MISSED);
        for row in rows {
            for cell in row * field.columns + columns.start..row * field.columns + columns.end {
                if self.missed[cell] <= min {
                    continue;
                }
                let place = field.centre(cell);
                let way = at.to(place);
                let is_in_view = view.holds_within(way, margin_m);
                if is_in_view && (!may_be_hidden || occupancy.is_visible(field, at, place, blur_m))
                {
                    let detection = detector.min_probability(way.length());
                    let above = self.missed[cell] - floor;
                    self.missed[cell] = floor + above * missed(detection, observations);
                }
            }
        }
    }
}

/// Probability that reported observations were not made.
#[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
fn distrusted(trust: f64) -> f32 {
    (1.0 - trust).clamp(0.0, 1.0) as f32
}

/// Probability that a number of observations miss an item that each detects with a given probability.
#[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
fn missed(detection: f64, observations: f64) -> f32 {
    let left = 1.0 - detection.min(MAX_DETECTION);
    if observations <= 1.0 {
        left as f32
    } else {
        libm::pow(left, observations) as f32
    }
}

/// The field of view of a detector, with directions in the world.
pub(crate) struct View {
    range_m: f64,
    /// The directions of its right and its left edge.
    edges: [Point; 2],
    width: Width,
}

enum Width {
    /// At most half a turn.
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

    /// The corners of a box that contains the field of view from a position.
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

    /// Whether a relative position is in view.
    #[inline]
    pub(crate) fn holds(&self, way: Point) -> bool {
        self.holds_within(way, 0.0)
    }

    /// Whether most of the cell at a relative position is in view.
    pub(crate) fn holds_cell(&self, field: &Field, way: Point) -> bool {
        self.holds_within(way, margin_m(field, self.range_m))
    }

    /// Whether a relative position is inside the field of view by a margin.
    #[inline]
    fn holds_within(&self, way: Point, margin_m: f64) -> bool {
        let max_m = self.range_m - margin_m;
        let [right, left] = self.edges;
        let is_left = right.cross(way) >= margin_m;
        let is_right = way.cross(left) >= margin_m;
        let is_between = match self.width {
            Width::Narrow => is_left && is_right,
            Width::Wide => is_left || is_right,
            Width::Round => true,
        };
        is_between && max_m > 0.0 && way.length_squared() <= max_m * max_m
    }
}

impl Detector {
    /// Probability that one observation detects an item of a kind at a distance.
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

    /// The minimum over all kinds that it can detect.
    pub(crate) fn min_probability(&self, distance_m: f64) -> f64 {
        let kinds = (0..self.detection_probability.len())
            .filter(|kind| !self.detection_probability[*kind].is_empty());
        let min = kinds
            .map(|kind| self.probability(kind, distance_m))
            .fold(f64::INFINITY, f64::min);
        if min.is_finite() { min } else { 0.0 }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::perception::beliefs::{BeliefsSpec, Map};
    use base::geometry::Rectangle;
    use proptest::prelude::*;

    /// A detector with a constant probability of detection.
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

    fn detected(map: &Map, unseen: &CoverageMap, x: f64, y: f64) -> f64 {
        1.0 - unseen.of(map.field.cell(Point { x, y }).unwrap())
    }

    fn observe(unseen: &mut CoverageMap, map: &Map, detector: &Detector, x: f64, trust: f64) {
        let scan = DetectorScan {
            detector,
            at: Point { x, y: 10.0 },
            heading_rad: 0.0,
            trust,
            observations: 1.0,
            blur_m: 0.0,
        };
        unseen.update(&map.field, &map.occupancy, &scan);
    }

    proptest! {
        #[test]
        fn the_box_contains_the_field_of_view(
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
    fn two_observations_with_probability_one_half_miss_a_quarter() {
        let (map, detector) = (map(), detector(3.0, 7.0, 0.5));
        let mut unseen = CoverageMap::new(map.field.cells());
        observe(&mut unseen, &map, &detector, 10.0, 1.0);
        observe(&mut unseen, &map, &detector, 10.0, 1.0);
        assert!((detected(&map, &unseen, 11.0, 11.0) - 0.75).abs() < 1e-6);
        assert!(detected(&map, &unseen, 14.0, 10.0) < 1e-9);
    }

    #[test]
    fn a_forward_detector_does_not_observe_cells_behind() {
        let (map, detector) = (map(), detector(3.0, 1.2, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        observe(&mut unseen, &map, &detector, 10.0, 1.0);
        assert!(detected(&map, &unseen, 12.0, 10.0) > MAX_DETECTION - 1e-6);
        assert!(
            detected(&map, &unseen, 8.0, 10.0) < 1e-9 && detected(&map, &unseen, 10.0, 12.0) < 1e-9
        );
    }

    #[test]
    fn each_observation_reduces_a_cell_and_none_sets_it_to_zero() {
        let (map, detector) = (map(), detector(3.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        let mut before = 1.0;
        for _ in 0..20 {
            observe(&mut unseen, &map, &detector, 10.0, 1.0);
            let left = unseen.of(map.field.nearest_cell(Point { x: 11.0, y: 10.0 }));
            assert!(0.0 < left && left < 0.21 * before);
            before = left;
        }
    }

    /// The thesis's example: own range 2, a sender 5 away with range 2, and full confidence.
    #[test]
    fn a_report_extends_the_map_around_its_sender_only() {
        let (map, detector) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        observe(&mut unseen, &map, &detector, 8.0, 1.0);
        observe(&mut unseen, &map, &detector, 13.0, 1.0);
        for x in [6.2, 9.8, 11.2, 14.8] {
            assert!(
                detected(&map, &unseen, x, 10.0) > MAX_DETECTION - 1e-6,
                "{x}"
            );
        }
        // Not a full disc with a radius of 5.
        for (x, y) in [(8.0, 14.0), (8.0, 6.0), (4.0, 10.0), (10.5, 12.0)] {
            assert!(detected(&map, &unseen, x, y) < 1e-9, "{x} {y}");
        }
    }

    #[test]
    fn a_report_has_the_weight_of_the_trust_in_its_sender() {
        let (map, detector) = (map(), detector(2.0, 7.0, 1.0));
        let mut unseen = CoverageMap::new(map.field.cells());
        observe(&mut unseen, &map, &detector, 13.0, 0.4);
        assert!((detected(&map, &unseen, 13.0, 11.0) - 0.4 * MAX_DETECTION).abs() < 1e-6);
    }

    #[test]
    fn repeated_reports_never_exceed_the_trust_in_their_sender() {
        let (map, detector) = (map(), detector(2.0, 7.0, 0.5));
        for trust in [0.05, 0.5, 0.9] {
            let mut unseen = CoverageMap::new(map.field.cells());
            for observations in 1..100 {
                observe(&mut unseen, &map, &detector, 13.0, trust);
                let expected = trust * (1.0 - libm::pow(0.5, f64::from(observations)));
                assert!((detected(&map, &unseen, 13.0, 11.0) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn reports_do_not_reverse_own_observations() {
        let (map, detector) = (map(), detector(2.0, 7.0, 0.8));
        let mut unseen = CoverageMap::new(map.field.cells());
        (0..3).for_each(|_| observe(&mut unseen, &map, &detector, 13.0, 1.0));
        let before = detected(&map, &unseen, 13.0, 11.0);
        observe(&mut unseen, &map, &detector, 13.0, 0.5);
        assert!((detected(&map, &unseen, 13.0, 11.0) - before).abs() < 1e-9);
    }

    #[test]
    fn a_detection_table_is_linear_between_its_pairs() {
        let mut table = detector(3.0, 7.0, 1.0);
        table.detection_probability = vec![vec![[1.0, 0.9], [3.0, 0.1]], vec![]];
        for (distance_m, expected) in [(0.0, 0.9), (2.0, 0.5), (5.0, 0.1)] {
            assert!((table.probability(0, distance_m) - expected).abs() < 1e-12);
        }
        assert!(table.probability(1, 1.0) < 1e-9 && table.probability(9, 1.0) < 1e-9);
        assert!((table.min_probability(2.0) - 0.5).abs() < 1e-12);
    }
}
