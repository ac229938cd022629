//! The field of view of an item detector, and its probability of detection.

use crate::io::body::Detector;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;
use core::f64::consts::{PI, SQRT_2, TAU};

/// A position counts as certainly in view if all edges are this many standard deviations away.
const CERTAIN: f64 = 3.5;

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
    pub(super) fn bounding_box(&self, at: Point) -> (Point, Point) {
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
    pub(crate) fn holds(&self, offset: Point) -> bool {
        self.holds_within(offset, 0.0)
    }

    /// Whether a relative position is outside of the field of view by more than a margin, as far as single edges show.
    #[inline]
    pub(crate) fn is_beyond(&self, offset: Point, margin_m: f64) -> bool {
        let [right, left] = self.edges;
        let (is_right, is_left) = (
            right.cross(offset) < -margin_m,
            offset.cross(left) < -margin_m,
        );
        let is_aside = match self.width {
            Width::Narrow => is_right || is_left,
            Width::Wide => is_right && is_left,
            Width::Round => false,
        };
        let max_m = self.range_m + margin_m;
        is_aside || offset.length_squared() > max_m * max_m
    }

    /// Probability that a relative position is in view that has a standard deviation, along each axis.
    ///
    /// Exact for one straight edge; the edges count as independent.
    pub(crate) fn probability(&self, offset: Point, deviation_m: f64) -> f64 {
        if self.holds_within(offset, CERTAIN * deviation_m) {
            return 1.0;
        }
        let inside = |margin_m: f64| {
            0.5 * libm::erfc(-margin_m / (deviation_m.max(f64::MIN_POSITIVE) * SQRT_2))
        };
        let [right, left] = self.edges;
        let (left_of, right_of) = (inside(right.cross(offset)), inside(offset.cross(left)));
        let between = match self.width {
            Width::Narrow => left_of * right_of,
            Width::Wide => 1.0 - (1.0 - left_of) * (1.0 - right_of),
            Width::Round => 1.0,
        };
        between * inside(self.range_m - offset.length())
    }

    /// Whether a relative position is inside the field of view by a margin.
    #[inline]
    fn holds_within(&self, offset: Point, margin_m: f64) -> bool {
        let max_m = self.range_m - margin_m;
        let [right, left] = self.edges;
        let is_left = right.cross(offset) >= margin_m;
        let is_right = offset.cross(left) >= margin_m;
        let is_between = match self.width {
            Width::Narrow => is_left && is_right,
            Width::Wide => is_left || is_right,
            Width::Round => true,
        };
        is_between && max_m > 0.0 && offset.length_squared() <= max_m * max_m
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
mod tests {
    use super::*;
    use crate::perception::beliefs::coverage_map::tests::detector;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_box_contains_the_field_of_view(
            width_rad in 0.1_f64..7.0, heading_rad in -4.0_f64..4.0,
            offset in (-3.0_f64..3.0, -3.0_f64..3.0), at in (-9.0_f64..9.0, -9.0_f64..9.0),
        ) {
            let view = View::new(&detector(3.0, width_rad, 1.0), heading_rad);
            let (offset, at) = (Point::from([offset.0, offset.1]), Point::from([at.0, at.1]));
            let ((low, high), position) = (view.bounding_box(at), at.plus(offset));
            let is_in = low.x <= position.x && position.x <= high.x && low.y <= position.y && position.y <= high.y;
            prop_assert!(is_in || !view.holds(offset));
        }
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
