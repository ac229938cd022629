//! Computations that several behaviours share.

use crate::io::body::Body;
use crate::io::command::Motion;

/// Straight ahead at a speed, by default the maximum speed of the body.
pub(super) fn ahead(speed_m_s: Option<f64>, body: &Body) -> Motion {
    Motion {
        speed_m_s: speed_m_s.unwrap_or(body.max_speed_m_s),
        turn_rate_rad_s: 0.0,
    }
}

/// Half the minimum range of all range rings, measured from the footprint's edge. Thresholds stay
/// below it, so that a missing return does not count as an obstacle.
pub(super) fn half_sight_m(body: &Body) -> f64 {
    let ranges_m = body.rings.iter().map(|ring| ring.range_m);
    let min_m = ranges_m.fold(f64::INFINITY, f64::min);
    (min_m - body.radius_m).max(0.0) / 2.0
}
