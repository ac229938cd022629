//! First-order lag: a value follows its setpoint exponentially.

/// Differences from the setpoint below this count as none, in m/s and rad/s: a body comes to a standstill in finite time.
const SETTLED: f64 = 1e-6;

/// A first-order lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lag {
    lag_s: f64,
    /// Over a whole step.
    step: Response,
}

/// A value after a time, and its integral over that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Followed {
    pub(crate) value: f64,
    pub(crate) integral: f64,
}

impl Lag {
    /// `None` without lag.
    pub(crate) fn new(lag_s: f64, step_s: f64) -> Option<Self> {
        (lag_s > 0.0).then(|| Self {
            lag_s,
            step: Response::new(lag_s, step_s),
        })
    }

    /// A value after one step towards its setpoint, if it changes by no more than `max_rate` per second.
    pub(crate) fn follow(&self, value: f64, setpoint: f64, max_rate: f64) -> Followed {
        let difference = value - setpoint;
        // Without a limit, the rate is the difference divided by the time constant.
        let limited_s = difference.abs() / max_rate - self.lag_s;
        if limited_s <= 0.0 {
            return self.step.follow(value, setpoint);
        }
        let step_s = self.step.time_s;
        let limited_s = limited_s.min(step_s);
        let after = value - max_rate.copysign(difference) * limited_s;
        let integral = f64::midpoint(value, after) * limited_s;
        if limited_s >= step_s {
            return Followed {
                value: after,
                integral,
            };
        }
        let rest = Response::new(self.lag_s, step_s - limited_s).follow(after, setpoint);
        Followed {
            integral: integral + rest.integral,
            ..rest
        }
    }
}

/// The response of a lag over a time.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Response {
    time_s: f64,
    /// Fraction of the difference from the setpoint that remains at its end.
    remaining: f64,
    /// Integral of that fraction.
    integral_s: f64,
}

impl Response {
    fn new(lag_s: f64, time_s: f64) -> Self {
        let change = libm::expm1(-time_s / lag_s);
        Self {
            time_s,
            remaining: 1.0 + change,
            integral_s: -lag_s * change,
        }
    }

    fn follow(&self, value: f64, setpoint: f64) -> Followed {
        let difference = value - setpoint;
        let remaining = difference * self.remaining;
        let is_settled = remaining.abs() < SETTLED;
        Followed {
            value: if is_settled {
                setpoint
            } else {
                setpoint + remaining
            },
            integral: setpoint * self.time_s + difference * self.integral_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_lag_loses_the_speed_times_its_time_constant_for_any_step() {
        for step_s in [0.001, 0.07, 0.1, 0.3, 2.0] {
            let lag = Lag::new(0.25, step_s).unwrap();
            let (mut speed, mut way_m, mut time_s) = (0.0, 0.0, 0.0);
            while speed != 2.0 {
                let followed = lag.follow(speed, 2.0, f64::INFINITY);
                (speed, way_m) = (followed.value, way_m + followed.integral);
                time_s += step_s;
            }
            assert!((2.0 * time_s - way_m - 2.0 * 0.25).abs() < 2e-6, "{step_s}");
        }
    }

    proptest! {
        /// The reference integrates the limited rate in small parts.
        #[test]
        fn a_lag_with_a_limited_rate_is_integrated_exactly(
            value in -2.0..2.0, setpoint in -2.0..2.0, lag_s in 0.01..2.0, rate in 0.1..20.0, step_s in 0.01..1.0,
        ) {
            let followed = Lag::new(lag_s, step_s).unwrap().follow(value, setpoint, rate);
            let parts = 40_000;
            let part_s = step_s / f64::from(parts);
            let slope = |now: f64| ((setpoint - now) / lag_s).clamp(-rate, rate);
            let (mut now, mut integral) = (value, 0.0);
            for _ in 0..parts {
                let next = now + slope(now + slope(now) * part_s / 2.0) * part_s;
                integral += f64::midpoint(now, next) * part_s;
                now = next;
            }
            prop_assert!((followed.value - now).abs() < 1e-5, "{followed:?} {now}");
            prop_assert!((followed.integral - integral).abs() < 1e-5, "{followed:?} {integral}");
        }

        #[test]
        fn a_lag_never_overshoots_and_keeps_its_rate(
            value in -9.0..9.0, setpoint in -9.0..9.0, lag_s in 1e-6..10.0, rate in 0.001..1000.0, step_s in 1e-3..10.0,
        ) {
            let after = Lag::new(lag_s, step_s).unwrap().follow(value, setpoint, rate).value;
            let (low, high) = (f64::min(value, setpoint), f64::max(value, setpoint));
            prop_assert!((low - 1e-9..=high + 1e-9).contains(&after), "{after}");
            prop_assert!((after - value).abs() <= rate * step_s + 2.0 * SETTLED);
        }
    }
}
