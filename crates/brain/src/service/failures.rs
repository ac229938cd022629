//! The goals that a robot could not serve: it bids for them later, and with less confidence.

use crate::io::goal_id::GoalId;
use crate::io::reason::Reason;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// Maximum number of goals; the oldest failure is forgotten first.
const MAX_GOALS: usize = 64;

/// Time without a bid after a failure, in seconds; each further one doubles it, up to a maximum.
const MIN_REST_S: f64 = 20.0;
const MAX_REST_S: f64 = 320.0;

/// The failures of a robot.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct Failures {
    list: Vec<Failure>,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct Failure {
    goal: GoalId,
    count: u8,
    rests_until_s: f64,
    /// Why the last attempt failed.
    reason: Reason,
}

impl Failures {
    /// Notes a failure; returns until when the goal rests.
    pub(crate) fn add(&mut self, goal: GoalId, reason: Reason, now_s: f64) -> f64 {
        let index = self.list.iter().position(|failure| failure.goal == goal);
        let count = index.map_or(0, |index| self.list.remove(index).count);
        if self.list.len() == MAX_GOALS {
            self.list.remove(0);
        }
        let rest_s = MIN_REST_S * libm::exp2(f64::from(count.min(8)));
        let rests_until_s = now_s + rest_s.min(MAX_REST_S);
        self.list.push(Failure {
            goal,
            count: count.saturating_add(1),
            rests_until_s,
            reason,
        });
        rests_until_s
    }

    /// Why the robot does not try a goal at this time, if it does not.
    pub(crate) fn reason_of_rest(&self, goal: GoalId, now_s: f64) -> Option<Reason> {
        let failure = self.of(goal)?;
        (now_s < failure.rests_until_s).then_some(failure.reason)
    }

    /// Probability that the next attempt succeeds: half after each failure.
    pub(crate) fn confidence(&self, goal: GoalId) -> f64 {
        let failure = self.of(goal);
        failure.map_or(1.0, |failure| libm::exp2(-f64::from(failure.count.min(8))))
    }

    fn of(&self, goal: GoalId) -> Option<&Failure> {
        self.list.iter().find(|failure| failure.goal == goal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_failure_halves_the_confidence_and_doubles_the_rest() {
        let (mut failures, goal) = (Failures::default(), GoalId::default());
        failures.add(goal, Reason::Unreachable, 0.0);
        assert!((failures.confidence(goal) - 0.5).abs() < 1e-12);
        assert!(
            failures.reason_of_rest(goal, 19.0).is_some()
                && failures.reason_of_rest(goal, 20.0).is_none()
        );
        failures.add(goal, Reason::Unreachable, 20.0);
        assert!((failures.confidence(goal) - 0.25).abs() < 1e-12);
        assert!(
            failures.reason_of_rest(goal, 59.0).is_some()
                && failures.reason_of_rest(goal, 60.0).is_none()
        );
    }
}
