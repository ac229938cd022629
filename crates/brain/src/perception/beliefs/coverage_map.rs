//! The coverage map: where an undetected item could still be.

use super::field::Field;
use super::occupancy::Occupancy;
use super::view::View;
use crate::io::body::Detector;
use alloc::vec;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hashed::Hashed;

/// For each cell, the probability that all observations so far would have missed an item there.
///
/// Each observation of a cell multiplies it by 1 - p, where p is the detector's probability of
/// detection at that distance (Koopman, *Search and screening*, 1946). If items are distributed
/// uniformly, the probability that an undetected item is in a cell is proportional to this value.
/// Four bytes per cell.
///
/// Reported observations are valid with the probability given by the trust in their sender, and
/// carry no information otherwise:
///
/// ```text
/// missed = 1 - trust (1 - (1 - p)^observations)
/// ```
///
/// This holds for all messages together: each reduces only the part above 1 - trust, and values
/// below that stay. A robot is therefore never believed more than it is trusted, however often it
/// repeats a report.
#[derive(Debug, Clone, Hashed)]
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

/// Maximum probability of detection of one observation: detector models and poses have errors. A
/// robot that has observed everything therefore continues, first where there were the fewest
/// observations.
pub(crate) const MAX_DETECTION: f64 = 0.8;

/// Minimum value of a cell, reached after about fifty observations; smaller numbers would be
/// denormal, which are slow.
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

/// A part of an observation in which an item may be taken for another one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mask {
    pub(crate) at: Point,
    pub(crate) radius_m: f64,
    /// Probability that an item there that is detected is not taken for the other one.
    pub(crate) reveals: f64,
}

/// A cell within a mask, with its value before an observation.
struct Masked {
    cell: usize,
    missed: f32,
    reveals: f32,
}

impl CoverageMap {
    /// Updates all cells of a field that are in view; those within masks as far as the look reveals an item there.
    pub(crate) fn update_with(
        &mut self,
        field: &Field,
        map: (&Field, &Occupancy),
        (scan, masks): (&DetectorScan, &[Mask]),
    ) {
        let each = masks.iter().flat_map(|mask| self.within(field, mask));
        let mut masked: Vec<Masked> = each.collect();
        self.update(field, map, scan);
        // A cell within several masks is looked at with the lowest probability.
        masked.sort_by(|one, other| {
            let order = one.cell.cmp(&other.cell);
            order.then(one.reveals.total_cmp(&other.reveals))
        });
        masked.dedup_by_key(|masked| masked.cell);
        for Masked {
            cell,
            missed,
            reveals,
        } in masked
        {
            self.missed[cell] = missed - (missed - self.missed[cell]) * reveals;
        }
    }

    /// The cells within a mask.
    #[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
    fn within(&self, field: &Field, mask: &Mask) -> Vec<Masked> {
        let Mask {
            at,
            radius_m,
            reveals,
        } = *mask;
        let reach = Point {
            x: radius_m,
            y: radius_m,
        };
        let [columns, rows] = field.columns_and_rows(reach.to(at), at.plus(reach));
        let cells = rows.flat_map(|row| {
            let first = row * field.columns;
            columns.clone().map(move |column| first + column)
        });
        let within = cells.filter(|cell| field.centre(*cell).to(at).length() <= radius_m);
        let masked = within.map(|cell| Masked {
            cell,
            missed: self.missed[cell],
            reveals: reveals as f32,
        });
        masked.collect()
    }

    /// Updates all cells of a field that are in view, on a map with its own field.
    pub(crate) fn update(
        &mut self,
        field: &Field,
        (map_field, occupancy): (&Field, &Occupancy),
        scan: &DetectorScan,
    ) {
        let DetectorScan {
            detector,
            at,
            heading_rad,
            trust,
            observations,
            blur_m,
        } = *scan;
        let view = View::new(detector, heading_rad);
        let (low, high) = view.bounding_box(at);
        let [columns, rows] = field.columns_and_rows(low, high);
        let may_be_hidden = detector.needs_line_of_sight && {
            let [columns, rows] = map_field.columns_and_rows(low, high);
            occupancy.is_any_in(map_field, &columns, &rows)
        };
        let floor = distrusted(trust);
        let min = floor.max(MIN_MISSED);
        // The last probability of detection, which is mostly that of the next cell, and the factor by it.
        let (mut detection, mut factor) = (f64::NAN, 1.0);
        for row in rows {
            for cell in row * field.columns + columns.start..row * field.columns + columns.end {
                if self.missed[cell] <= min {
                    continue;
                }
                let centre = field.centre(cell);
                let offset = at.to(centre);
                let is_in_view = view.holds(offset);
                if is_in_view
                    && (!may_be_hidden || occupancy.is_visible(map_field, at, centre, blur_m))
                {
                    let at_cell = detector.min_probability(offset.length());
                    if at_cell.to_bits() != detection.to_bits() {
                        (detection, factor) = (at_cell, missed(at_cell, observations));
                    }
                    self.missed[cell] = floor + (self.missed[cell] - floor) * factor;
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

/// Probability that a number of observations miss an item that each detects with a given
/// probability.
#[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
fn missed(detection: f64, observations: f64) -> f32 {
    let left = 1.0 - detection.min(MAX_DETECTION);
    if observations <= 1.0 {
        left as f32
    } else {
        libm::pow(left, observations) as f32
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::perception::beliefs::{BeliefsSpec, Map};
    use base::geometry::Rectangle;

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

    fn detected(map: &Map, coverage: &CoverageMap, x: f64, y: f64) -> f64 {
        1.0 - coverage.of(map.field.cell(Point { x, y }).unwrap())
    }

    fn observe(coverage: &mut CoverageMap, map: &Map, detector: &Detector, x: f64, trust: f64) {
        let scan = DetectorScan {
            detector,
            at: Point { x, y: 10.0 },
            heading_rad: 0.0,
            trust,
            observations: 1.0,
            blur_m: 0.0,
        };
        coverage.update(&map.field, (&map.field, &map.occupancy), &scan);
    }

    #[test]
    fn two_observations_with_probability_one_half_miss_a_quarter() {
        let (map, detector) = (map(), detector(3.0, 7.0, 0.5));
        let mut coverage = CoverageMap::new(map.field.cells());
        observe(&mut coverage, &map, &detector, 10.0, 1.0);
        observe(&mut coverage, &map, &detector, 10.0, 1.0);
        assert!((detected(&map, &coverage, 11.0, 11.0) - 0.75).abs() < 1e-6);
        assert!(detected(&map, &coverage, 14.0, 10.0) < 1e-9);
    }

    #[test]
    fn a_forward_detector_does_not_observe_cells_behind() {
        let (map, detector) = (map(), detector(3.0, 1.2, 1.0));
        let mut coverage = CoverageMap::new(map.field.cells());
        observe(&mut coverage, &map, &detector, 10.0, 1.0);
        assert!(detected(&map, &coverage, 12.0, 10.0) > MAX_DETECTION - 1e-6);
        assert!(
            detected(&map, &coverage, 8.0, 10.0) < 1e-9
                && detected(&map, &coverage, 10.0, 12.0) < 1e-9
        );
    }

    #[test]
    fn each_observation_reduces_a_cell_and_none_sets_it_to_zero() {
        let (map, detector) = (map(), detector(3.0, 7.0, 1.0));
        let mut coverage = CoverageMap::new(map.field.cells());
        let mut before = 1.0;
        for _ in 0..20 {
            observe(&mut coverage, &map, &detector, 10.0, 1.0);
            let left = coverage.of(map.field.nearest_cell(Point { x: 11.0, y: 10.0 }));
            assert!(0.0 < left && left < 0.21 * before);
            before = left;
        }
    }

    /// The thesis's example: own range 2, a sender 5 away with range 2, and full confidence.
    #[test]
    fn a_report_extends_the_map_around_its_sender_only() {
        let (map, detector) = (map(), detector(2.0, 7.0, 1.0));
        let mut coverage = CoverageMap::new(map.field.cells());
        observe(&mut coverage, &map, &detector, 8.0, 1.0);
        observe(&mut coverage, &map, &detector, 13.0, 1.0);
        for x in [6.2, 9.8, 11.2, 14.8] {
            assert!(
                detected(&map, &coverage, x, 10.0) > MAX_DETECTION - 1e-6,
                "{x}"
            );
        }
        // Not a full disc with a radius of 5.
        for (x, y) in [(8.0, 14.0), (8.0, 6.0), (4.0, 10.0), (10.5, 12.0)] {
            assert!(detected(&map, &coverage, x, y) < 1e-9, "{x} {y}");
        }
    }

    #[test]
    fn a_report_has_the_weight_of_the_trust_in_its_sender() {
        let (map, detector) = (map(), detector(2.0, 7.0, 1.0));
        let mut coverage = CoverageMap::new(map.field.cells());
        observe(&mut coverage, &map, &detector, 13.0, 0.4);
        assert!((detected(&map, &coverage, 13.0, 11.0) - 0.4 * MAX_DETECTION).abs() < 1e-6);
    }

    #[test]
    fn repeated_reports_never_exceed_the_trust_in_their_sender() {
        let (map, detector) = (map(), detector(2.0, 7.0, 0.5));
        for trust in [0.05, 0.5, 0.9] {
            let mut coverage = CoverageMap::new(map.field.cells());
            for observations in 1..100 {
                observe(&mut coverage, &map, &detector, 13.0, trust);
                let expected = trust * (1.0 - libm::pow(0.5, f64::from(observations)));
                assert!((detected(&map, &coverage, 13.0, 11.0) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn reports_do_not_reverse_own_observations() {
        let (map, detector) = (map(), detector(2.0, 7.0, 0.8));
        let mut coverage = CoverageMap::new(map.field.cells());
        (0..3).for_each(|_| observe(&mut coverage, &map, &detector, 13.0, 1.0));
        let before = detected(&map, &coverage, 13.0, 11.0);
        observe(&mut coverage, &map, &detector, 13.0, 0.5);
        assert!((detected(&map, &coverage, 13.0, 11.0) - before).abs() < 1e-9);
    }
}
