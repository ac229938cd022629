//! The repulsion of obstacles.

use crate::situation::Situation;
use base::geometry::Point;

/// The vector away from all obstacles within `influence_m` of the robot's footprint: length 0 at
/// that distance, 1 at contact, linear between.
///
/// The nearest obstacle determines the length, and the mean of all of them the direction. So the
/// number of rays that hit an obstacle does not matter, and equal obstacles on both sides cancel
/// out.
pub(super) fn vector(influence_m: f64, situation: &Situation) -> Point {
    let (mut sum, mut total, mut max) = (Point::default(), 0.0, 0.0_f64);
    for (ring, ranges_m) in situation.scans() {
        for ray in ring.rays(ranges_m) {
            let gap_m = (ray.range_m - situation.body.radius_m).max(0.0);
            if gap_m >= influence_m || ray.range_m >= ring.range_m() {
                continue;
            }
            let strength = 1.0 - gap_m / influence_m;
            sum = sum.plus(ray.direction.times(strength));
            total += strength;
            max = max.max(strength);
        }
    }
    if total > 0.0 {
        sum.times(-max / total)
    } else {
        Point::default()
    }
}
