//! How much a goal is worth going for now: its utility.

use crate::goals::proposal::Destination;

/// What is so many seconds away is worth half of what is here.
const HALF_S: f64 = 10.0;

/// A battery should last for so many times the way.
const MARGIN: f64 = 1.5;

/// A goal's precedence, recomputed in every cycle:
///
/// ```text
/// precedence = value x P(it can be reached) / (1 + t / 10 s)
/// P = min(1, time that the battery lasts / (1.5 t)),   t = way / speed
/// ```
///
/// The nearer and the likelier a goal is, the higher it stands; one that is worth nothing, or cannot
/// be reached, comes last.
pub(crate) fn precedence(aim: &Destination, time_s: f64, battery_s: f64) -> f64 {
    let precedence = aim.value * likely(time_s, battery_s) / (1.0 + time_s / HALF_S);
    if precedence.is_finite() {
        precedence
    } else {
        0.0
    }
}

/// Probability that it can be reached, P above.
#[inline]
pub(crate) fn likely(time_s: f64, battery_s: f64) -> f64 {
    let needed_s = MARGIN * time_s;
    if needed_s > battery_s {
        battery_s / needed_s
    } else {
        1.0
    }
}

/// Time that a way takes.
pub(crate) fn time_s(way_m: f64, aim: &Destination) -> f64 {
    if way_m <= aim.within_m {
        0.0
    } else {
        way_m / aim.speed_m_s.max(1e-6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::geometry::Point;

    const AIM: Destination = Destination {
        to: Point { x: 0.0, y: 0.0 },
        within_m: 0.5,
        speed_m_s: 2.0,
        value: 3.0,
    };

    #[test]
    fn precedence_is_the_value_halved_by_ten_seconds_of_way() {
        assert!((precedence(&AIM, 0.0, 100.0) - 3.0).abs() < 1e-12);
        assert!((precedence(&AIM, time_s(20.0, &AIM), 100.0) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn what_the_battery_does_not_last_for_comes_later() {
        let far_s = time_s(20.0, &AIM);
        assert!((precedence(&AIM, far_s, 7.5) - 0.75).abs() < 1e-12);
        assert!(precedence(&AIM, far_s, 0.0) == 0.0);
    }

    #[test]
    fn nonsense_has_no_precedence() {
        assert!(precedence(&AIM, f64::NAN, 1.0) == 0.0);
        let endless = Destination {
            value: f64::INFINITY,
            ..AIM
        };
        assert!(precedence(&endless, 1.0, 1.0) == 0.0);
    }
}
