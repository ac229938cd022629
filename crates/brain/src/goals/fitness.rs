//! The progress towards a goal.

use crate::goals::proposal::Destination;
use crate::io::goal_id::GoalPlace;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The robot makes progress when the path to the goal is shorter by this than ever before, in
/// metres; more if its position is noisy.
const PROGRESS_M: f64 = 0.1;

/// Time without progress after which the robot recedes, and after which the goal is impossible, in
/// seconds.
const RECEDING_S: f64 = 4.0;
const IMPOSSIBLE_S: f64 = 30.0;

/// Time for which an impossible goal is not tried again, in seconds; other goals are served
/// meanwhile.
const REST_S: f64 = 10.0;

/// The state of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The robot has reached it.
    Complete,
    /// There is no known path, the battery does not last, or the robot has tried for too long.
    Impossible,
    /// The robot comes nearer.
    Approaching,
    /// The robot has not come nearer for some time.
    Receding,
}

/// The situation of one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) at: Point,
    /// Time since the previous step, and the time that a step is expected to take.
    pub(crate) elapsed_s: f64,
    pub(crate) period_s: f64,
    /// A goal to which no path is known.
    pub(crate) unreachable: Option<GoalPlace>,
    /// Remaining battery time.
    pub(crate) battery_s: f64,
    /// The goal that was pursued in the last step, and the path length to it. For other goals, time
    /// without progress does not count.
    pub(crate) pursued: Option<(GoalPlace, f64)>,
    /// Standard deviation of `at` from one step to the next; 0 for a filtered position.
    pub(crate) noise_m: f64,
}

impl Step {
    /// The robot makes progress when the path is shorter by this than ever before.
    pub(crate) fn min_progress_m(&self) -> f64 {
        PROGRESS_M + 2.0 * self.noise_m
    }

    /// Maximum change of the path length in this step; beyond it, the path is another one.
    fn max_change_m(&self, max_speed_m_s: f64) -> f64 {
        max_speed_m_s * self.elapsed_s + PROGRESS_M + 6.0 * self.noise_m
    }

    /// Path length to a goal; only a straight line unless it is the pursued one.
    fn remaining_m(&self, goal: GoalPlace) -> f64 {
        let known = self.pursued.filter(|(pursued, _)| *pursued == goal);
        known.map_or_else(
            || self.at.to(goal.at).length(),
            |(_, remaining_m)| remaining_m,
        )
    }
}

/// The progress towards one goal so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitness {
    /// The minimum path length so far, and that of the last step.
    pub(crate) best_m: f64,
    pub(crate) last_m: f64,
    /// Time without progress.
    pub(crate) stuck_s: f64,
    /// Remaining time for which the goal counts as impossible.
    pub(crate) rest_s: f64,
}

impl Default for Fitness {
    fn default() -> Self {
        Self {
            best_m: f64::INFINITY,
            last_m: f64::INFINITY,
            stuck_s: 0.0,
            rest_s: 0.0,
        }
    }
}

impl Fitness {
    pub(crate) fn is_resting(&self) -> bool {
        self.rest_s > 0.0
    }

    /// Lets the goal count as impossible for some time.
    pub(crate) fn start_rest(&mut self) {
        self.rest_s = REST_S;
    }

    /// Takes a step into account, and returns the verdict:
    ///
    /// ```text
    /// complete      distance <= tolerance
    /// impossible    no known path, or battery time < path length / speed, or no progress for 30 s;
    ///               and for 10 s after that
    /// receding      no progress for 4 s
    /// approaching   otherwise
    /// ```
    pub(crate) fn update(&mut self, destination: &Destination, step: &Step) -> Verdict {
        if self.is_resting() {
            self.rest_s -= step.elapsed_s;
            if !self.is_resting() {
                *self = Self::default();
            }
        }
        let remaining_m = step.remaining_m(destination.goal());
        self.track(remaining_m, destination, step);
        let is_out_of_range = super::time_s(remaining_m, destination) > step.battery_s;
        let is_unreachable = step.unreachable == Some(destination.goal());
        let is_stuck = self.stuck_s > IMPOSSIBLE_S;
        if step.at.to(destination.at).length() <= destination.tolerance_m {
            Verdict::Complete
        } else if self.is_resting() || is_unreachable || is_out_of_range || is_stuck {
            Verdict::Impossible
        } else if self.stuck_s > RECEDING_S {
            Verdict::Receding
        } else {
            Verdict::Approaching
        }
    }

    fn track(&mut self, remaining_m: f64, destination: &Destination, step: &Step) {
        // No robot moves that far in a step: the old path is blocked, or a shorter one was found.
        let max_change_m = step.max_change_m(destination.max_speed_m_s);
        let is_new_path = (remaining_m - self.last_m).abs() > max_change_m;
        self.last_m = remaining_m;
        if is_new_path {
            self.best_m = remaining_m;
        } else if remaining_m < self.best_m - step.min_progress_m() {
            (self.best_m, self.stuck_s) = (remaining_m, 0.0);
        } else if step
            .pursued
            .is_some_and(|(pursued, _)| pursued == destination.goal())
        {
            // A gap between percepts alone does not make a goal impossible.
            self.stuck_s += step.elapsed_s.min(step.period_s.max(RECEDING_S));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::body::RobotId;
    use crate::io::goal_id::GoalId;

    const GOAL: Destination = Destination {
        id: GoalId {
            issuer: RobotId { kind: 0, index: 0 },
            number: 1,
        },
        at: Point { x: 9.0, y: 0.0 },
        tolerance_m: 0.5,
        max_speed_m_s: 1.0,
        value: 1.0,
    };

    /// At a distance from the goal, with a path of some length left.
    fn step(distance_m: f64, remaining_m: f64) -> Step {
        Step {
            at: Point {
                x: GOAL.at.x - distance_m,
                y: 0.0,
            },
            elapsed_s: 1.0,
            period_s: 1.0,
            unreachable: None,
            battery_s: 20.0,
            pursued: Some((GOAL.goal(), remaining_m)),
            noise_m: 0.0,
        }
    }

    #[test]
    fn a_robot_that_comes_nearer_approaches_until_the_goal_is_complete() {
        let mut fitness = Fitness::default();
        for remaining_m in [9.0, 8.0, 7.0, 3.0] {
            let verdict = fitness.update(&GOAL, &step(remaining_m, remaining_m));
            assert_eq!(verdict, Verdict::Approaching);
        }
        assert_eq!(fitness.update(&GOAL, &step(0.4, 0.4)), Verdict::Complete);
    }

    #[test]
    fn without_progress_a_robot_recedes_until_the_goal_is_impossible() {
        let mut fitness = Fitness::default();
        let verdicts: Vec<Verdict> = (0..40)
            .map(|_| fitness.update(&GOAL, &step(5.0, 5.0)))
            .collect();
        assert_eq!(verdicts[4], Verdict::Approaching);
        assert_eq!(verdicts[6], Verdict::Receding);
        assert_eq!(verdicts[35], Verdict::Impossible);
    }

    #[test]
    fn a_robot_on_a_detour_approaches_while_its_path_shortens() {
        let mut fitness = Fitness::default();
        for remaining_m in (0..40).map(|step| 60.0 - f64::from(step)) {
            let step = Step {
                battery_s: 100.0,
                ..step(5.0, remaining_m)
            };
            assert_eq!(fitness.update(&GOAL, &step), Verdict::Approaching);
        }
    }

    #[test]
    fn a_robot_that_finds_its_path_longer_approaches_while_the_new_one_shortens() {
        let mut fitness = Fitness::default();
        fitness.update(&GOAL, &step(5.0, 5.0));
        for remaining_m in [18.0, 17.0, 16.0, 15.0, 14.0, 13.0, 12.0] {
            let verdict = fitness.update(&GOAL, &step(5.0, remaining_m));
            assert_eq!(verdict, Verdict::Approaching);
        }
    }

    #[test]
    fn goals_beyond_the_battery_or_without_a_path_are_impossible() {
        let empty = Step {
            battery_s: 3.0,
            ..step(5.0, 5.0)
        };
        let unreachable = Step {
            unreachable: Some(GOAL.goal()),
            ..step(5.0, 5.0)
        };
        for step in [empty, unreachable] {
            let verdict = Fitness::default().update(&GOAL, &step);
            assert_eq!(verdict, Verdict::Impossible);
        }
    }
}
