//! What a look from a place promises.

use crate::io::body::Detector;
use crate::perception::beliefs::Map;
use crate::perception::beliefs::coverage_map::MAX_DETECTION;
use crate::perception::beliefs::pose::turned;
use crate::perception::beliefs::view::View;
use crate::perception::sector::direction;
use alloc::vec::Vec;
use base::geometry::Point;

/// A detector's view is sampled at places that are so many to its range.
const SAMPLES: f64 = 6.0;

/// No detector is so bad that it would need more than some hundred looks.
const LEAST_SEEN: f64 = 0.01;

/// What a body's detectors see.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outlook {
    samples: Vec<Sample>,
    /// All that a look promises where nobody has looked.
    pub(crate) most: f64,
    needs_line_of_sight: bool,
}

/// A part of what is seen.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// From the robot's front.
    at: Point,
    area_m2: f64,
    /// How likely a look sees what is there.
    seen: f64,
}

impl Outlook {
    /// That of a body with such detectors.
    pub(crate) fn new(detectors: &[Detector]) -> Self {
        let samples: Vec<Sample> = detectors.iter().flat_map(samples).collect();
        let promises = samples.iter().map(|sample| sample.area_m2 * sample.seen);
        Self {
            most: promises.sum(),
            needs_line_of_sight: detectors.iter().any(|one| one.needs_line_of_sight),
            samples,
        }
    }

    /// So many looks miss e^-`nats` of what is in view.
    pub(crate) fn looks(&self, nats: f64) -> f64 {
        let all_m2 = self
            .samples
            .iter()
            .map(|sample| sample.area_m2)
            .sum::<f64>();
        let seen = self.most / all_m2.max(f64::MIN_POSITIVE);
        nats / -libm::log1p(-seen.clamp(LEAST_SEEN, MAX_DETECTION))
    }

    /// How many items a look from a place would find at the end of a way there, if there were an unseen one
    /// in each square metre, unless something hides them.
    pub(crate) fn at_best(&self, map: &Map, at: Point, way: Point) -> f64 {
        self.sum(map, at, way, |_| true)
    }

    /// The same of what nothing hides.
    pub(crate) fn promises(&self, map: &Map, at: Point, way: Point, blur_m: f64) -> f64 {
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
            let left = sample.area_m2 * sample.seen * map.coverage.of(cell);
            (left > 0.0 && counts(place)).then_some(left)
        });
        found.sum()
    }
}

/// Those of one detector: the middles of squares, as far as it sees them.
#[expect(clippy::cast_possible_truncation, reason = "some six each way")]
fn samples(detector: &Detector) -> impl Iterator<Item = Sample> {
    let apart_m = detector.range_m / SAMPLES;
    let view = View::new(detector, 0.0);
    let most = SAMPLES as i32;
    let places = (-most..=most).flat_map(move |up| (-most..=most).map(move |right| [right, up]));
    let places = places.map(move |place| Point::from(place.map(f64::from)).times(apart_m));
    places
        .filter(move |at| view.holds(*at))
        .map(move |at| Sample {
            at,
            area_m2: apart_m * apart_m,
            seen: detector.min_probability(at.length()),
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

    fn eye() -> Detector {
        Detector {
            needs_line_of_sight: true,
            ..detector(3.0, 1.2, 1.0)
        }
    }

    fn glance(eye: &Detector) -> DetectorScan<'_> {
        DetectorScan {
            detector: eye,
            at: HERE,
            heading_rad: 0.0,
            trust: 1.0,
            observations: 1.0,
            blur_m: 0.0,
        }
    }

    fn promises(map: &Map, way: Point, blur_m: f64) -> f64 {
        Outlook::new(&[eye()]).promises(map, HERE, way, blur_m)
    }

    #[test]
    fn a_look_promises_what_nobody_has_seen_the_way_that_it_faces() {
        let (mut map, eye) = (map(), eye());
        let [ahead, back] = [AHEAD, AHEAD.times(-1.0)];
        let [before, behind] = [ahead, back].map(|way| promises(&map, way, 0.0));
        assert!((before - 5.4).abs() < 0.8, "{before}");
        map.coverage
            .update(&map.field, &map.occupancy, &glance(&eye));
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
                free: Segment { from: HERE, to },
                hit: Some(to),
            };
            (0..5).for_each(|_| map.occupancy.add_ray(&map.field, &ray));
        }
        let [sure, unsure] = [0.0, 0.5].map(|blur_m| promises(&map, AHEAD, blur_m));
        assert!(
            sure < 0.5 * open && sure < unsure && unsure < open,
            "{sure} {unsure} {open}"
        );
    }

    #[test]
    fn the_worse_a_detector_is_the_more_looks_a_place_takes() {
        let looks = |seen: f64| Outlook::new(&[detector(3.0, 1.2, seen)]).looks(2.0);
        assert!((looks(0.3) - 5.6).abs() < 0.1 && (looks(0.1) - 19.0).abs() < 0.1);
        assert!(looks(1.0) < 2.0 && looks(0.0) < 200.0);
    }

    #[test]
    fn what_is_promised_is_as_much_as_is_seen_however_coarse_the_map_is() {
        let corner = Point { x: 500.0, y: 500.0 };
        let area = Rectangle::spanned(Point::default(), corner);
        let coarse = Map::new(&BeliefsSpec::default(), &area);
        let [one, other] = [&map(), &coarse].map(|map| promises(map, AHEAD, 0.0));
        assert!((one - other).abs() < 1e-9 && one > 4.0, "{one} {other}");
    }
}
