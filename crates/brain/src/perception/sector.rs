//! The area that a moving body can sweep.

use base::geometry::{Point, Segment};
use base::trig::sin_cos;

/// The area that a body can sweep: everything within half its width of a straight path in any
/// direction between two.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sector {
    sides: [Side; 3],
}

/// The points with `normal . point <= at`.
#[derive(Debug, Clone, Copy)]
struct Side {
    normal: Point,
    at: f64,
}

impl Sector {
    /// Directions from `from_rad` anticlockwise to `to_rad`, at most half a turn apart, for a body
    /// of this half width.
    pub(crate) fn new(from_rad: f64, to_rad: f64, half_width_m: f64) -> Self {
        let right_of = |ahead: Point| Point {
            x: ahead.y,
            y: -ahead.x,
        };
        let behind = direction(f64::midpoint(from_rad, to_rad)).times(-1.0);
        // Directly beside the body in its outermost directions.
        let (beside, _) = sin_cos((to_rad - from_rad) / 2.0);
        let side = |normal, at| Side { normal, at };
        Self {
            sides: [
                side(right_of(direction(from_rad)), half_width_m),
                side(right_of(direction(to_rad)).times(-1.0), half_width_m),
                side(behind, half_width_m * beside),
            ],
        }
    }

    /// The part of a segment that lies inside or within `margin_m` of it, if any.
    #[inline]
    pub(crate) fn part(&self, segment: Segment, margin_m: f64) -> Option<Segment> {
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for side in &self.sides {
            let from = side.normal.dot(segment.from) - side.at - margin_m;
            let to = side.normal.dot(segment.to) - side.at - margin_m;
            if from > 0.0 && to > 0.0 {
                return None;
            } else if from > 0.0 {
                first = first.max(from / (from - to));
            } else if to > 0.0 {
                last = last.min(from / (from - to));
            }
        }
        let along = |share: f64| segment.from.plus(segment.way().times(share));
        (first <= last).then(|| Segment {
            from: along(first),
            to: along(last),
        })
    }
}

/// The unit vector of a bearing.
pub(crate) fn direction(bearing_rad: f64) -> Point {
    let (y, x) = sin_cos(bearing_rad);
    Point { x, y }
}
