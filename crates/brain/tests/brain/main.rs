//! The brain through its public interface, without a simulator: one binary, to link only once.

mod homing;
mod percepts;
mod poses;
mod trust;

use brain::{Body, Reading};

/// A robot of 0.5 m that drives at up to 1 m/s.
fn body() -> Body {
    Body {
        radius_m: 0.25,
        max_speed_m_s: 1.0,
        max_acceleration_m_s2: 1.0,
        max_turn_rate_rad_s: 1.5,
        period_s: 0.1,
        ..Body::default()
    }
}

/// A reading without delay.
const fn now<T>(value: T) -> Reading<T> {
    Reading { value, age_s: 0.0 }
}
