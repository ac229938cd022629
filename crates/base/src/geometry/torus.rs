//! Periodic worlds.

use super::Point;

/// A rectangle with a corner at the origin and periodic boundaries.
///
/// Each point has images, one width or height apart. The distance between two points of the rectangle
/// is that to the nearest image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Torus {
    /// Width and height, in metres.
    pub size_m: Point,
}

impl Torus {
    /// The image of a point in the rectangle: from 0 (included) to its size (excluded).
    #[must_use]
    #[inline]
    pub fn home(self, place: Point) -> Point {
        Point {
            x: home(place.x, self.size_m.x),
            y: home(place.y, self.size_m.y),
        }
    }

    /// The image of `place` that is nearest to `from`; both are in the rectangle.
    #[must_use]
    #[inline]
    pub fn image(self, from: Point, place: Point) -> Point {
        Point {
            x: image(from.x, place.x, self.size_m.x),
            y: image(from.y, place.y, self.size_m.y),
        }
    }

    /// Whether `image` is the nearest image to `from`. Exactly one image of a point is.
    #[must_use]
    #[inline]
    pub fn is_nearest(self, from: Point, image: Point) -> bool {
        let is_near = |way_m: f64, size_m: f64| -size_m / 2.0 < way_m && way_m <= size_m / 2.0;
        let way = from.to(image);
        is_near(way.x, self.size_m.x) && is_near(way.y, self.size_m.y)
    }

    /// The offsets of the eight neighbouring images of the rectangle.
    pub fn shifts(self) -> impl Iterator<Item = Point> {
        let Point { x, y } = self.size_m;
        let columns = [-x, 0.0, x].into_iter();
        let all = columns.flat_map(move |x| [-y, 0.0, y].map(|y| Point { x, y }));
        all.filter(|shift| *shift != Point::default())
    }

    /// The other images of a point of the rectangle that are within `reach_m` of the rectangle.
    pub fn images_within(self, place: Point, reach_m: f64) -> impl Iterator<Item = Point> {
        let images = self.shifts().map(move |shift| place.plus(shift));
        let is_near = move |at_m: f64, size_m: f64| -reach_m <= at_m && at_m <= size_m + reach_m;
        images.filter(move |at| is_near(at.x, self.size_m.x) && is_near(at.y, self.size_m.y))
    }
}

#[inline]
fn home(at_m: f64, size_m: f64) -> f64 {
    if (0.0..size_m).contains(&at_m) {
        return at_m;
    }
    let inside_m = at_m - size_m * (at_m / size_m).floor();
    // Rounding may exceed either side slightly.
    if (0.0..size_m).contains(&inside_m) {
        inside_m
    } else {
        0.0
    }
}

#[inline]
fn image(from_m: f64, at_m: f64, size_m: f64) -> f64 {
    let way_m = at_m - from_m;
    if way_m > size_m / 2.0 {
        at_m - size_m
    } else if way_m <= -size_m / 2.0 {
        at_m + size_m
    } else {
        at_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TORUS: Torus = Torus {
        size_m: Point { x: 10.0, y: 4.0 },
    };

    fn point((x, y): (f64, f64)) -> Point {
        Point { x, y }
    }

    proptest! {
        #[test]
        fn a_place_comes_home_by_whole_sizes(at in (-1e4..1e4, -1e4..1e4)) {
            let home = TORUS.home(point(at));
            prop_assert!((0.0..10.0).contains(&home.x) && (0.0..4.0).contains(&home.y));
            let turns = [(at.0 - home.x) / 10.0, (at.1 - home.y) / 4.0];
            prop_assert!(turns.iter().all(|turns| (turns - turns.round()).abs() < 1e-9));
        }

        #[test]
        fn the_nearest_image_is_no_farther_than_any(
            from in (0.0..10.0, 0.0..4.0), to in (0.0..10.0, 0.0..4.0),
        ) {
            let (from, to) = (point(from), point(to));
            let image = TORUS.image(from, to);
            let images = TORUS.shifts().map(|shift| to.plus(shift)).chain([to]);
            let min_m = images.map(|image| from.to(image).length()).fold(f64::INFINITY, f64::min);
            prop_assert!((from.to(image).length() - min_m).abs() < 1e-12);
            let nearest = TORUS.shifts().map(|shift| to.plus(shift)).chain([to]);
            prop_assert_eq!(nearest.filter(|image| TORUS.is_nearest(from, *image)).count(), 1);
            prop_assert!(TORUS.is_nearest(from, image));
        }
    }

    #[test]
    fn what_is_a_hair_outside_comes_home() {
        for hair in [-1e-300, -1e-17, 10.0, 10.0 + 1e-15, 1e300] {
            let home = TORUS.home(Point { x: hair, y: 0.0 });
            assert!((0.0..10.0).contains(&home.x), "{hair}");
        }
    }

    #[test]
    fn images_are_those_within_reach() {
        let corner = Point { x: 0.5, y: 3.9 };
        let images: Vec<Point> = TORUS.images_within(corner, 1.0).collect();
        let expected = [(0.5, -0.1), (10.5, 3.9), (10.5, -0.1)];
        assert_eq!(images.len(), 3);
        for at in expected {
            assert!(
                images
                    .iter()
                    .any(|image| image.to(point(at)).length() < 1e-12)
            );
        }
    }
}
