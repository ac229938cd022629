//! What obstacles repel.

use crate::perception::situation::Situation;
use base::geometry::Point;

/// Away from what range rings see nearer than `influence_m` from the hull: 0 there, 1 long at contact,
/// linear between. Of several obstacles the nearest says how much, and their mean where to, so that it
/// does not matter how many rays meet one, and between two alike nothing is left.
pub(super) fn vector(influence_m: f64, situation: &Situation) -> Point {
    let (mut sum, mut total, mut most) = (Point::default(), 0.0, 0.0_f64);
    for (ring, ranges_m) in situation.scans() {
        for ray in ring.rays(ranges_m) {
            let gap_m = (ray.range_m - situation.body.radius_m).max(0.0);
            if gap_m >= influence_m || ray.range_m >= ring.range_m() {
                continue;
            }
            let strength = 1.0 - gap_m / influence_m;
            sum = sum.plus(ray.direction.times(strength));
            total += strength;
            most = most.max(strength);
        }
    }
    if total > 0.0 {
        sum.times(-most / total)
    } else {
        Point::default()
    }
}
