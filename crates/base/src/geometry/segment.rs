//! Straight walls.

use super::Point;

/// A straight wall from one point to another: free on its left, solid on its right.
///
/// Adjacent segments have bit-identical common ends, so that rounding opens no gap between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Start point.
    pub from: Point,
    /// End point.
    pub to: Point,
}

impl Segment {
    /// The vector from its start to its end.
    #[must_use]
    pub fn way(&self) -> Point {
        self.from.to(self.to)
    }

    /// Its length.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.way().length()
    }

    /// Its closest point to `point`; the start of a segment without length.
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

    /// Distance from `point` to the segment.
    #[must_use]
    pub fn distance_m(&self, point: Point) -> f64 {
        self.nearest(point).to(point).length()
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
    }

    #[test]
    fn a_segment_without_length_is_its_beginning() {
        let here = Point { x: 3.0, y: 4.0 };
        let wall = Segment {
            from: here,
            to: here,
        };
        assert!((wall.distance_m(Point::default()) - 5.0).abs() < 1e-15);
    }
}
