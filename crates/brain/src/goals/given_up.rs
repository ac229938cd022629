//! The goals that a robot has given up, and when it tries them again.

use crate::io::goal_id::GoalPlace;
use crate::io::reason::Reason;
use alloc::vec::Vec;
use base::hashed::Hashed;

/// A goal is tried again after this time, in seconds; each failure doubles it, up to a maximum.
const MIN_REST_S: f64 = 10.0;
const MAX_REST_S: f64 = 160.0;

/// Maximum number of goals: beyond it, the one whose last failure is the oldest is forgotten.
const MAX_GOALS: usize = 16;

/// The goals that a robot has given up.
#[derive(Debug, Clone, Default, Hashed)]
pub(crate) struct GivenUp {
    /// By their last failures, the oldest first.
    goals: Vec<Rest>,
}

#[derive(Debug, Clone, Copy, Hashed)]
struct Rest {
    goal: GoalPlace,
    /// Remaining time until it is tried again.
    left_s: f64,
    /// Duration after the last failure.
    total_s: f64,
    /// Why it failed.
    reason: Reason,
    /// Whether the map has not been marked stale since it failed.
    is_map_older: bool,
}

impl GivenUp {
    pub(crate) fn advance(&mut self, elapsed_s: f64) {
        for rest in &mut self.goals {
            rest.left_s = (rest.left_s - elapsed_s).max(0.0);
        }
    }

    /// Time until a goal is tried again; 0 if it need not rest.
    pub(crate) fn rest_s(&self, goal: GoalPlace) -> f64 {
        let mut goals = self.goals.iter();
        let known = goals.find(|rest| rest.goal == goal);
        known.map_or(0.0, |rest| rest.left_s)
    }

    /// Whether a goal has failed before.
    pub(crate) fn contains(&self, goal: GoalPlace) -> bool {
        self.goals.iter().any(|rest| rest.goal == goal)
    }

    /// Begins to try a goal again. Returns whether the map is to be marked stale: if it has not been since
    /// the goal failed. Goals that fail one after the other thus share what the robot observes again.
    pub(crate) fn begin_retry(&mut self, goal: GoalPlace) -> bool {
        let mut goals = self.goals.iter();
        let is_due = goals.any(|rest| rest.goal == goal && rest.is_map_older);
        if is_due {
            for rest in &mut self.goals {
                rest.is_map_older = false;
            }
        }
        is_due
    }

    /// Why a goal failed last.
    pub(crate) fn reason(&self, goal: GoalPlace) -> Option<Reason> {
        let mut goals = self.goals.iter();
        goals.find(|rest| rest.goal == goal).map(|rest| rest.reason)
    }

    /// Lets a goal rest after a failure: for the minimum time after the first one and while the battery
    /// does not last, as it may be charged meanwhile; otherwise for twice as long as last time.
    pub(crate) fn add(&mut self, goal: GoalPlace, reason: Reason) {
        let factor = if reason == Reason::Battery { 1.0 } else { 2.0 };
        let total_s = self
            .forget(goal)
            .map_or(MIN_REST_S, |rest| (factor * rest.total_s).min(MAX_REST_S));
        if self.goals.len() == MAX_GOALS {
            self.goals.remove(0);
        }
        self.goals.push(Rest {
            goal,
            left_s: total_s,
            total_s,
            reason,
            is_map_older: true,
        });
    }

    /// Forgets a goal that has been reached.
    pub(crate) fn remove(&mut self, goal: GoalPlace) {
        self.forget(goal);
    }

    fn forget(&mut self, goal: GoalPlace) -> Option<Rest> {
        let index = self.goals.iter().position(|rest| rest.goal == goal)?;
        Some(self.goals.remove(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::goal_id::GoalId;

    fn goal(number: u32) -> GoalPlace {
        let id = GoalId {
            number,
            ..GoalId::default()
        };
        GoalPlace {
            id,
            at: base::geometry::Point::default(),
        }
    }

    #[test]
    fn each_failure_doubles_the_rest_up_to_a_maximum_until_the_goal_is_reached() {
        let mut given_up = GivenUp::default();
        for rest_s in [10.0, 20.0, 40.0, 80.0, 160.0, 160.0] {
            given_up.add(goal(1), Reason::Unreachable);
            assert_eq!(given_up.rest_s(goal(1)).to_bits(), f64::to_bits(rest_s));
            given_up.advance(rest_s);
            assert!(given_up.rest_s(goal(1)) <= 0.0);
        }
        given_up.remove(goal(1));
        given_up.add(goal(1), Reason::Unreachable);
        assert_eq!(given_up.rest_s(goal(1)).to_bits(), f64::to_bits(10.0));
    }

    #[test]
    fn goals_that_failed_before_the_map_was_marked_stale_do_not_mark_it_again() {
        let mut given_up = GivenUp::default();
        (1..3).for_each(|number| given_up.add(goal(number), Reason::Unreachable));
        assert!(!given_up.begin_retry(goal(3)));
        assert!(given_up.begin_retry(goal(1)));
        assert!(!given_up.begin_retry(goal(1)) && !given_up.begin_retry(goal(2)));
        given_up.add(goal(2), Reason::Unreachable);
        assert!(given_up.begin_retry(goal(2)) && !given_up.begin_retry(goal(1)));
    }

    #[test]
    fn the_number_of_goals_is_bounded_and_the_oldest_failure_is_forgotten() {
        let mut given_up = GivenUp::default();
        (0..100).for_each(|number| given_up.add(goal(number), Reason::Position));
        assert_eq!(given_up.goals.len(), MAX_GOALS);
        assert!(given_up.rest_s(goal(0)) <= 0.0 && given_up.rest_s(goal(99)) > 0.0);
        assert_eq!(given_up.reason(goal(99)), Some(Reason::Position));
    }
}
