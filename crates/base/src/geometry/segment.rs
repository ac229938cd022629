//! A straight wall.

use super::Point;

/// A straight wall from one point to another: free on its left, solid on its right.
///
/// Two segments that meet have the same bits in the common end: what is asked of an end has one
/// answer for both, and rounding opens no crack between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Its beginning.
    pub from: Point,
    /// Its end.
    pub to: Point,
}

impl Segment {
    /// The way from its beginning to its end.
    #[must_use]
    pub fn way(&self) -> Point {
        self.from.to(self.to)
    }

    /// Its length.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.way().length()
    }

    /// Its point nearest to `point`; of a segment without length, its beginning.
    #[must_use]
    pub fn nearest(&self, point: Point) -> Point {
        let way = self.way();
        let along = self.from.to(point).dot(way);
        let length_squared = way.length_squared();
        if along <= 0.0 || length_squared == 0.0 {
            self.from
        } else if along >= length_squared {
            self.to
        } else {
            self.from.plus(way.times(along / length_squared))
        }
    }

    /// Distance from `point` to the nearest point of the segment.
    #[must_use]
    pub fn distance_m(&self, point: Point) -> f64 {
        self.nearest(point).to(point).length()
    }

    /// Where the ray from `origin` along `direction` comes upon the segment from its free side, in
    /// lengths of `direction`, at least 0; from the solid side, or along it, it meets nothing.
    ///
    /// On which side of the ray an end lies is asked of that end alone, and an end on the ray counts
    /// for both sides. So a ray between two segments with a common end meets at least one of them,
    /// whatever is rounded: a closed outline has no cracks.
    #[must_use]
    pub fn hit(&self, origin: Point, direction: Point) -> Option<f64> {
        let (from, to) = (origin.to(self.from), origin.to(self.to));
        let (right, left) = (direction.cross(from), direction.cross(to));
        let comes_from_free = right <= 0.0 && left >= 0.0 && left > right;
        let ahead = (direction.dot(from) * left - direction.dot(to) * right)
            / ((left - right) * direction.length_squared());
        (comes_from_free && ahead >= 0.0).then_some(ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        (-50.0..50.0, -50.0..50.0).prop_map(|(x, y)| Point { x, y })
    }

    fn segment() -> impl Strategy<Value = Segment> {
        (point(), point()).prop_map(|(from, to)| Segment { from, to })
    }

    proptest! {
        #[test]
        fn no_point_of_a_segment_is_nearer_than_the_nearest(
            segment in segment(), point in point(), share in 0.0_f64..=1.0,
        ) {
            let other = segment.from.plus(segment.way().times(share));
            prop_assert!(segment.distance_m(point) <= other.to(point).length() + 1e-9);
            let nearest = segment.nearest(point);
            let on_it = segment.from.to(nearest).length() + nearest.to(segment.to).length();
            prop_assert!((on_it - segment.length_m()).abs() < 1e-9);
        }

        #[test]
        fn a_ray_to_a_point_of_a_segment_meets_it_there_from_its_left_only(
            segment in segment(), origin in point(), share in 0.01..0.99,
        ) {
            let target = segment.from.plus(segment.way().times(share));
            let side = segment.way().cross(segment.from.to(origin));
            prop_assume!(side.abs() > 1e-3);
            let hit = segment.hit(origin, origin.to(target));
            if side > 0.0 {
                prop_assert!((hit.unwrap() - 1.0).abs() < 1e-6);
            } else {
                prop_assert_eq!(hit, None);
            }
        }

        #[test]
        fn no_ray_slips_between_two_segments_with_a_common_end(
            origin in point(), corner in point(), ulps in -8_i32..=8,
            (left_along, left_aside) in (-0.9_f64..9.0, 0.01_f64..9.0),
            (right_along, right_aside) in (-0.9_f64..9.0, 0.01_f64..9.0),
        ) {
            let to_corner = origin.to(corner);
            prop_assume!(to_corner.length() > 1e-3);
            let aside = Point { x: -to_corner.y, y: to_corner.x };
            let end = |along: f64, left: f64| {
                corner.plus(to_corner.times(along)).plus(aside.times(left))
            };
            let left = end(left_along, left_aside);
            let right = end(right_along, -right_aside);
            let walls = [
                Segment { from: right, to: corner },
                Segment { from: corner, to: left },
            ];
            // As near to the corner as numbers go.
            let x = to_corner.x * (1.0 + f64::from(ulps) * f64::EPSILON);
            let direction = Point { x, ..to_corner };
            prop_assert!(walls.iter().any(|wall| wall.hit(origin, direction).is_some()));
        }
    }

    #[test]
    fn a_segment_behind_the_ray_is_not_met() {
        let wall = Segment {
            from: [1.0, -1.0].into(),
            to: [1.0, 1.0].into(),
        };
        assert_eq!(wall.hit([0.0, 0.0].into(), [2.0, 0.0].into()), Some(0.5));
        assert_eq!(wall.hit([0.0, 0.0].into(), [-2.0, 0.0].into()), None);
    }

    #[test]
    fn a_segment_without_length_is_its_beginning() {
        let here = Point { x: 3.0, y: 4.0 };
        let wall = Segment {
            from: here,
            to: here,
        };
        assert!((wall.distance_m(Point::default()) - 5.0).abs() < 1e-15);
        assert_eq!(wall.hit(Point::default(), here), None);
    }
}
