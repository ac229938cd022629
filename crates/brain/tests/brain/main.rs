//! The brain through its public interface: one binary, to link only once.

#![expect(
    clippy::unnecessary_wraps,
    clippy::unwrap_used,
    reason = "fields of percepts are optional, and tests may panic"
)]

mod headings;
mod homing;
mod lane;
mod layers;
mod orders;
mod percepts;
mod poses;
mod serve;
mod times;
mod trust;

use base::geometry::Point;
use brain::{Body, Brain, BrainSpec, Percept, Reading};
use std::sync::Arc;

/// A small robot without sensors.
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

/// The brain of a specification in JSON.
fn brain(spec: &str, body: Body) -> Brain {
    let spec: BrainSpec = serde_json::from_str(spec).unwrap();
    Brain::new(Arc::new(spec), Arc::new(body))
}

/// A reading of age 0.
const fn now<T>(value: T) -> Option<Reading<T>> {
    Some(Reading { value, age_s: 0.0 })
}

/// A percept of a pose alone.
fn percept_at(x: f64, y: f64, heading_rad: f64) -> Percept {
    Percept {
        position: now(Point { x, y }),
        heading_rad: now(heading_rad),
        ..Percept::default()
    }
}
