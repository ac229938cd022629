//! The current utility of a goal.

use crate::goals::proposal::Destination;

/// A goal this far away, in seconds, is worth half as much as one here.
const HALF_S: f64 = 10.0;

/// Required battery time, as a multiple of the time for the path.
const RESERVE_FACTOR: f64 = 1.5;

/// The precedence of a goal, recomputed in every step:
///
/// ```text
/// precedence = value x P(reachable) / (1 + t / 10 s)
/// P(reachable) = min(1, battery time / (1.5 t)),   t = path length / speed
/// ```
///
/// Near and likely reachable goals come first; goals without value or out of reach come last.
pub(crate) fn precedence(destination: &Destination, time_s: f64, battery_s: f64) -> f64 {
    let reachable = reachable_probability(time_s, battery_s);
    let precedence = destination.value * reachable / (1.0 + time_s / HALF_S);
    if precedence.is_finite() {
        precedence
    } else {
        0.0
    }
}

/// Probability that the battery lasts, from 0 to 1.
#[inline]
pub(crate) fn reachable_probability(time_s: f64, battery_s: f64) -> f64 {
    let needed_s = RESERVE_FACTOR * time_s;
    if needed_s > battery_s {
        battery_s / needed_s
    } else {
        1.0
    }
}

/// Time to a destination over a path of this length; 0 within its tolerance.
pub(crate) fn time_s(path_m: f64, destination: &Destination) -> f64 {
    if path_m <= destination.tolerance_m {
        0.0
    } else {
        path_m / destination.max_speed_m_s.max(1e-6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::agent_id::AgentId;
    use crate::io::goal_id::{GoalId, Issuer};
    use base::geometry::Point;

    const DESTINATION: Destination = Destination {
        id: GoalId {
            issuer: Issuer::Agent(AgentId::robot(0, 0)),
            number: 1,
        },
        at: Point { x: 0.0, y: 0.0 },
        tolerance_m: 0.5,
        max_deviation_m: 0.25,
        is_at_hazard: false,
        max_speed_m_s: 2.0,
        value: 3.0,
    };

    fn precedence(time_s: f64, battery_s: f64) -> f64 {
        super::precedence(&DESTINATION, time_s, battery_s)
    }

    #[test]
    fn precedence_is_the_value_halved_by_ten_seconds_of_path() {
        assert!((precedence(0.0, 100.0) - 3.0).abs() < 1e-12);
        assert!((precedence(time_s(20.0, &DESTINATION), 100.0) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn goals_that_the_battery_may_not_reach_come_later() {
        let far_s = time_s(20.0, &DESTINATION);
        assert!((precedence(far_s, 7.5) - 0.75).abs() < 1e-12);
        assert!(precedence(far_s, 0.0) == 0.0);
    }

    #[test]
    fn precedence_of_invalid_numbers_is_zero() {
        assert!(precedence(f64::NAN, 1.0) == 0.0);
        let endless = Destination {
            value: f64::INFINITY,
            ..DESTINATION
        };
        assert!(super::precedence(&endless, 1.0, 1.0) == 0.0);
    }
}
