//! What several behaviours compute alike.

use crate::io::body::Body;
use crate::io::command::Motion;

/// Straight ahead at a speed, or else as fast as the body can.
pub(super) fn ahead(speed_m_s: Option<f64>, body: &Body) -> Motion {
    Motion {
        speed_m_s: speed_m_s.unwrap_or(body.max_speed_m_s),
        turn_rate_rad_s: 0.0,
    }
}

/// Half as far from the hull as all range rings see: nearer than that a lost echo is no obstacle.
pub(super) fn half_sight_m(body: &Body) -> f64 {
    let ranges_m = body.rings.iter().map(|ring| ring.range_m);
    let least_m = ranges_m.fold(f64::INFINITY, f64::min);
    (least_m - body.radius_m).max(0.0) / 2.0
}
