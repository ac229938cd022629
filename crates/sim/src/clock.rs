//! Steps and seconds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time step, time limit, and the clocks of robots and controllers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClockSpec {
    /// Length of a time step, in seconds.
    #[serde(default = "tenth")]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub step_s: f64,
    /// A run ends at this time at the latest, in seconds. A run that is not complete by then has
    /// failed.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub time_limit_s: f64,
    /// The clock of each robot and controller is ahead by a random time, of its own in each run, from 0 to this, in
    /// seconds.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub max_offset_s: f64,
    /// The clock of each robot and controller gains a random time, of its own in each run, from minus this to this,
    /// in seconds per second.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub max_drift: f64,
}

fn tenth() -> f64 {
    0.1
}

/// Parts of a second to which times are rounded.
const PARTS_PER_S: f64 = 1e9;

/// The time of a number of steps, rounded for results: 564 steps of 0.1 s are 56.4 s, whereas the
/// product is 56.400000000000006.
#[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
pub(crate) fn seconds(tick: u64, step_s: f64) -> f64 {
    (tick as f64 * step_s * PARTS_PER_S).round() / PARTS_PER_S
}

#[cfg(test)]
mod tests {
    use super::seconds;

    #[test]
    fn times_of_decimal_steps_are_the_nearest_number_to_their_decimals() {
        for (step_s, steps_per_s) in [(0.1, 10.0), (0.05, 20.0), (0.02, 50.0), (0.001, 1000.0)] {
            for tick in (0..1_000_000_u32).chain([99_999_999, 100_000_000]) {
                let exact = f64::from(tick) / steps_per_s;
                assert_eq!(
                    seconds(u64::from(tick), step_s),
                    exact,
                    "{tick} of {step_s}"
                );
            }
        }
    }

    #[test]
    fn a_time_is_within_a_billionth_of_a_second_of_its_steps() {
        for step_s in [0.001, 0.1, 1.0 / 3.0, 0.123_456_789_012, 10.0] {
            for tick in [0_u32, 1, 2, 3, 1000, 1_000_000] {
                let product = f64::from(tick) * step_s;
                assert!((seconds(u64::from(tick), step_s) - product).abs() < 1e-9);
            }
        }
    }
}
