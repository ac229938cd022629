//! Stub.
use crate::{Body, BrainSpec, Command, Percept};
use std::sync::Arc;
/// Stub.
#[derive(Debug, Clone)]
pub struct Brain {
    body: Arc<Body>,
    turning_until_s: f64,
    rate: f64,
}
impl Brain {
    /// Stub.
    #[must_use]
    pub fn new(_spec: Arc<BrainSpec>, body: Arc<Body>) -> Self {
        Self {
            body,
            turning_until_s: 0.0,
            rate: 0.0,
        }
    }
    /// Stub.
    pub fn step_into(&mut self, percept: &Percept, command: &mut Command) {
        command.requests.clear();
        command.outbox.clear();
        let mut ahead = f64::INFINITY;
        if let Some(scan) = percept.scans.first() {
            let n = scan.ranges_m.len();
            for (k, r) in scan.ranges_m.iter().enumerate() {
                if k <= n / 8 || k + n / 8 >= n {
                    ahead = ahead.min(*r);
                }
            }
        }
        let touch = percept.touch.is_some_and(|t| t.value);
        if percept.time_s >= self.turning_until_s && (ahead < self.body.radius_m + 0.5 || touch) {
            self.rate = if percept.dice[0] & 1 == 0 {
                self.body.max_turn_rate_rad_s
            } else {
                -self.body.max_turn_rate_rad_s
            };
            self.turning_until_s = percept.time_s
                + f64::from(percept.dice[1] >> 16) / 65536.0 * 3.0 / self.body.max_turn_rate_rad_s;
        }
        command.motion = if percept.time_s < self.turning_until_s {
            crate::Motion {
                speed_m_s: 0.0,
                turn_rate_rad_s: self.rate,
            }
        } else {
            crate::Motion {
                speed_m_s: self.body.max_speed_m_s,
                turn_rate_rad_s: 0.0,
            }
        };
    }
}
