//! The expected detections of a measurement at a place.

use crate::io::body::Detector;
use crate::perception::beliefs::Map;
use crate::perception::beliefs::coverage_map::MAX_DETECTION;
use crate::perception::beliefs::pose::turned;
use crate::perception::beliefs::view::View;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;

/// Sample points of a detector's view per range.
const SAMPLES: f64 = 6.0;

/// Minimum assumed detection probability, which bounds the number of measurements.
const MIN_DETECTION: f64 = 0.01;

/// The view of a body's detectors.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outlook {
    samples: Vec<Sample>,
    /// The expected detections of a measurement in an unobserved area.
    pub(crate) max: f64,
    needs_line_of_sight: bool,
}

/// A part of the view.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Position relative to the robot's front.
    at: Point,
    area_m2: f64,
    /// Detection probability.
    probability: f64,
}

impl Outlook {
    /// The view of a body with these detectors.
    pub(crate) fn new(detectors: &[Detector]) -> Self {
        let samples: Vec<Sample> = detectors.iter().flat_map(samples).collect();
        let expected = samples
            .iter()
            .map(|sample| sample.area_m2 * sample.probability);
        Self {
            max: expected.sum(),
            needs_line_of_sight: detectors.iter().any(|one| one.needs_line_of_sight),
            samples,
        }
    }

    /// The number of measurements that leave a fraction e^-`nats` of the items in view undetected.
    pub(crate) fn measurements(&self, nats: f64) -> f64 {
        let all_m2 = self
            .samples
            .iter()
            .map(|sample| sample.area_m2)
            .sum::<f64>();
        let seen = self.max / all_m2.max(f64::MIN_POSITIVE);
        nats / -libm::log1p(-seen.clamp(MIN_DETECTION, MAX_DETECTION))
    }

    /// The expected detections of a measurement at the end of a path, with one undetected item per
    /// square metre of unobserved area, ignoring occlusion.
    pub(crate) fn at_best(&self, map: &Map, at: Point, way: Point) -> f64 {
        self.sum(map, at, way, |_| true)
    }

    /// The same with occlusion.
    pub(crate) fn expected(&self, map: &Map, at: Point, way: Point, blur_m: f64) -> f64 {
        self.sum(map, at, way, |place| {
            !self.needs_line_of_sight || map.occupancy.is_visible(&map.field, at, place, blur_m)
        })
    }

    #[inline]
    fn sum(&self, map: &Map, at: Point, way: Point, counts: impl Fn(Point) -> bool) -> f64 {
        let length_m = way.length();
        let front = if length_m > 0.0 {
            way.times(1.0 / length_m)
        } else {
            direction(0.0)
        };
        let found = self.samples.iter().filter_map(|sample| {
            let place = at.plus(turned(sample.at, front));
            let cell = map.field.cell(place)?;
            let left = sample.area_m2 * sample.probability * map.coverage.of(cell);
            (left > 0.0 && counts(place)).then_some(left)
        });
        found.sum()
    }
}

/// The samples of one detector: the centres of squares in its view.
#[expect(
    clippy::cast_possible_truncation,
    reason = "about six in each direction"
)]
fn samples(detector: &Detector) -> impl Iterator<Item = Sample> {
    let apart_m = detector.range_m / SAMPLES;
    let view = View::new(detector, 0.0);
    let max = SAMPLES as i32;
    let places = (-max..=max).flat_map(move |up| (-max..=max).map(move |right| [right, up]));
    let places = places.map(move |place| Point::from(place.map(f64::from)).times(apart_m));
    places
        .filter(move |at| view.holds(*at))
        .map(move |at| Sample {
            at,
            area_m2: apart_m * apart_m,
            probability: detector.min_probability(at.length()),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::perception::beliefs::BeliefsSpec;
    use crate::perception::beliefs::coverage_map::DetectorScan;
    use crate::perception::beliefs::coverage_map::tests::{detector, map};
    use crate::perception::beliefs::occupancy::Ray;
    use base::geometry::{Rectangle, Segment};

    const HERE: Point = Point { x: 10.1, y: 10.1 };
    const AHEAD: Point = Point { x: 1.0, y: 0.0 };

    fn camera() -> Detector {
        Detector {
            needs_line_of_sight: true,
            ..detector(3.0, 1.2, 1.0)
        }
    }

    fn scan(camera: &Detector) -> DetectorScan<'_> {
        DetectorScan {
            detector: camera,
            at: HERE,
            heading_rad: 0.0,
            trust: 1.0,
            observations: 1.0,
            blur_m: 0.0,
        }
    }

    fn expected(map: &Map, way: Point, blur_m: f64) -> f64 {
        Outlook::new(&[camera()]).expected(map, HERE, way, blur_m)
    }

    #[test]
    fn expected_detections_are_those_of_unobserved_area_in_the_direction_of_the_path() {
        let (mut map, camera) = (map(), camera());
        let [ahead, back] = [AHEAD, AHEAD.times(-1.0)];
        let [before, behind] = [ahead, back].map(|way| expected(&map, way, 0.0));
        assert!((before - 5.4).abs() < 0.8, "{before}");
        map.coverage
            .update(&map.field, (&map.field, &map.occupancy), &scan(&camera));
        assert!(expected(&map, ahead, 0.0) < 0.5 * before);
        assert!((expected(&map, back, 0.0) - behind).abs() < 1e-9);
    }

    #[test]
    fn obstacles_hide_what_is_behind_them_in_proportion_to_their_certainty() {
        let mut map = map();
        let open = expected(&map, AHEAD, 0.0);
        for y in 0..30 {
            let to = Point {
                x: 11.1,
                y: 8.0 + 0.15 * f64::from(y),
            };
            let ray = Ray {
                free: Segment { from: HERE, to },
                hit: Some(to),
            };
            (0..5).for_each(|_| map.occupancy.add_ray(&map.field, &ray));
        }
        let [certain, uncertain] = [0.0, 0.5].map(|blur_m| expected(&map, AHEAD, blur_m));
        assert!(
            certain < 0.5 * open && certain < uncertain && uncertain < open,
            "{certain} {uncertain} {open}"
        );
    }

    #[test]
    fn a_lower_detection_probability_requires_more_measurements() {
        let measurements = |seen: f64| Outlook::new(&[detector(3.0, 1.2, seen)]).measurements(2.0);
        assert!((measurements(0.3) - 5.6).abs() < 0.1 && (measurements(0.1) - 19.0).abs() < 0.1);
        assert!(measurements(1.0) < 2.0 && measurements(0.0) < 200.0);
    }

    #[test]
    fn expected_detections_do_not_depend_on_the_cell_size() {
        let corner = Point { x: 500.0, y: 500.0 };
        let area = Rectangle::spanned(Point::default(), corner);
        let coarse = Map::new(&BeliefsSpec::default(), &area);
        let [one, other] = [&map(), &coarse].map(|map| expected(map, AHEAD, 0.0));
        assert!((one - other).abs() < 1e-9 && one > 4.0, "{one} {other}");
    }
}
