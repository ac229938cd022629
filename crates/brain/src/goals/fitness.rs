//! The progress towards a goal.

use crate::goals::proposal::Destination;
use crate::io::goal_id::GoalPlace;
use crate::io::reason::Reason;
pub use crate::io::verdict::Verdict;
use base::geometry::Point;
use base::hashed::Hashed;

/// The robot makes progress when the path to the goal is shorter by this than ever before, in
/// metres; more if its position is noisy.
pub(crate) const PROGRESS_M: f64 = 0.1;

/// Time without progress after which the robot recedes, and after which the goal is impossible, in
/// seconds.
const RECEDING_S: f64 = 4.0;
pub(crate) const IMPOSSIBLE_S: f64 = 30.0;

/// A discovery that makes the path longer by more than this leads elsewhere, in metres: the time without
/// progress starts over. One that lengthens it by less, such as a further cell of an obstacle that the path
/// passes, does not.
const DETOUR_M: f64 = 2.0;

/// The situation of one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) at: Point,
    /// Standard deviation of `at`, along each axis.
    pub(crate) deviation_m: f64,
    /// Time since the previous step, and the time that a step is expected to take.
    pub(crate) elapsed_s: f64,
    pub(crate) period_s: f64,
    /// A goal to which no path is known.
    pub(crate) unreachable: Option<GoalPlace>,
    /// Remaining battery time.
    pub(crate) battery_s: f64,
    /// The goal that was pursued in the last step. For other goals, time without progress does not
    /// count.
    pub(crate) pursued: Option<Pursuit>,
    /// Standard deviation of `at` from one step to the next; 0 for a filtered position.
    pub(crate) noise_m: f64,
}

/// The pursuit of a goal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pursuit {
    pub(crate) goal: GoalPlace,
    /// Path length to it.
    pub(crate) remaining_m: f64,
    /// By how much a new path is longer because of a cell that was discovered to be occupied, or less than 0 if
    /// it is shorter.
    pub(crate) added_m: f64,
}

impl Step {
    /// The robot makes progress when the path is shorter by this than ever before.
    pub(crate) fn min_progress_m(&self) -> f64 {
        PROGRESS_M + 2.0 * self.noise_m
    }
}

/// The progress towards one goal so far.
#[derive(Debug, Clone, Copy, Default, Hashed)]
pub(crate) struct Fitness {
    /// Path length in the last step; only a straight line while another goal is pursued.
    pub(crate) last_m: f64,
    /// The difference between it and the minimum so far.
    behind_m: f64,
    /// By how much the minimum has been raised by discoveries.
    raised_m: f64,
    /// Time without progress.
    pub(crate) stuck_s: f64,
    /// Whether the goal was pursued in the last step.
    is_pursued: bool,
    /// Whether the robot has seemed to be there since its last progress, but did not know its position
    /// well enough.
    pub(crate) is_uncertain: bool,
}

impl Fitness {
    /// The minimum path length so far. What the path became longer while another goal was pursued
    /// is added.
    pub(crate) fn min_m(&self) -> f64 {
        (self.last_m - self.behind_m).max(0.0)
    }

    /// Takes a step into account, and returns the verdict:
    ///
    /// ```text
    /// complete      distance <= tolerance, and the position is known well enough for that
    /// impossible    no known path, or battery time < path length / speed, or no progress for 30 s
    /// receding      no progress for 4 s
    /// approaching   otherwise
    /// ```
    pub(crate) fn update(&mut self, destination: &Destination, step: &Step) -> Verdict {
        self.track(destination, step);
        let is_unreachable = step.unreachable == Some(destination.goal());
        let is_reached = destination.is_reached(step.at, step.deviation_m);
        self.is_uncertain |= destination.is_uncertain(step.at, step.deviation_m);
        if is_reached {
            Verdict::Complete
        } else if is_unreachable || self.is_stuck() || self.is_beyond_battery(destination, step) {
            Verdict::Impossible
        } else if self.stuck_s > RECEDING_S {
            Verdict::Receding
        } else {
            Verdict::Approaching
        }
    }

    /// Counts a step as time without progress. A gap between percepts alone does not make a goal
    /// impossible.
    pub(crate) fn count(&mut self, elapsed_s: f64, period_s: f64) {
        self.stuck_s += elapsed_s.min(period_s.max(RECEDING_S));
    }

    /// Whether the robot has made no progress for too long.
    pub(crate) fn is_stuck(&self) -> bool {
        self.stuck_s > IMPOSSIBLE_S
    }

    /// Why the goal is impossible.
    pub(crate) fn reason(&self, destination: &Destination, step: &Step) -> Reason {
        if self.is_beyond_battery(destination, step) {
            Reason::Battery
        } else {
            self.reason_of_time()
        }
    }

    /// Why the robot has made no progress for too long.
    pub(crate) fn reason_of_time(&self) -> Reason {
        if self.is_uncertain {
            Reason::Position
        } else {
            Reason::Unreachable
        }
    }

    /// Whether the battery does not last for the path.
    pub(crate) fn is_beyond_battery(&self, destination: &Destination, step: &Step) -> bool {
        super::time_s(self.last_m, destination) > step.battery_s
    }

    /// Progress is only a path that is shorter than ever before: a path that jumps between two
    /// lengths is none. What a discovery adds to the path raises the minimum too, until a new path is shorter
    /// again, and a detour starts the time over. As each cell is discovered only once, this ends.
    fn track(&mut self, destination: &Destination, step: &Step) {
        let pursued = step
            .pursued
            .filter(|pursued| pursued.goal == destination.goal());
        let was_pursued = core::mem::replace(&mut self.is_pursued, pursued.is_some());
        let before_m = self.last_m;
        let Some(pursued) = pursued else {
            self.last_m = step.at.to(destination.at).length();
            return;
        };
        self.last_m = pursued.remaining_m;
        if was_pursued {
            let raised_m = pursued.added_m.max(-self.raised_m);
            self.raised_m += raised_m;
            self.behind_m += pursued.remaining_m - before_m - raised_m;
        }
        if self.behind_m < -step.min_progress_m() {
            (self.behind_m, self.stuck_s) = (0.0, 0.0);
            self.is_uncertain = false;
        } else if pursued.added_m > DETOUR_M {
            self.stuck_s = 0.0;
            self.is_uncertain = false;
        } else if was_pursued {
            self.count(step.elapsed_s, step.period_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::agent_id::AgentId;
    use crate::io::goal_id::{GoalId, Issuer};

    const GOAL: Destination = Destination {
        id: GoalId {
            issuer: Issuer::Agent(AgentId::robot(0, 0)),
            number: 1,
        },
        at: Point { x: 9.0, y: 0.0 },
        tolerance_m: 0.5,
        max_deviation_m: 0.25,
        is_at_hazard: false,
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
            deviation_m: 0.0,
            elapsed_s: 1.0,
            period_s: 1.0,
            unreachable: None,
            battery_s: 20.0,
            pursued: Some(Pursuit {
                goal: GOAL.goal(),
                remaining_m,
                added_m: 0.0,
            }),
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
    fn a_goal_is_complete_once_the_position_is_known_well_enough() {
        let mut fitness = Fitness::default();
        let there = |deviation_m| Step {
            deviation_m,
            ..step(0.1, 0.1)
        };
        assert_eq!(fitness.update(&GOAL, &there(0.26)), Verdict::Approaching);
        assert!(fitness.is_uncertain);
        assert_eq!(fitness.update(&GOAL, &there(0.25)), Verdict::Complete);
        let verdicts = (0..40).map(|_| fitness.update(&GOAL, &there(0.26)));
        assert_eq!(verdicts.last(), Some(Verdict::Impossible));
        assert!(fitness.is_uncertain);
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

    /// The verdicts while a path of 5 m jumps to 18 m, and then becomes shorter by 0.5 m/s.
    fn after_a_jump(is_discovery: bool) -> Vec<Verdict> {
        let mut fitness = Fitness::default();
        (0..5).for_each(|_| {
            fitness.update(&GOAL, &step(5.0, 5.0));
        });
        let verdicts = (0..26).map(|second| {
            let mut step = step(5.0, 18.0 - 0.5 * f64::from(second));
            let pursued = step.pursued.as_mut().unwrap();
            if is_discovery && second == 0 {
                pursued.added_m = 13.0;
            }
            fitness.update(&GOAL, &step)
        });
        verdicts.collect()
    }

    #[test]
    fn a_robot_that_discovers_an_obstacle_approaches_while_its_new_path_shortens() {
        let is_approaching = |verdict: &Verdict| *verdict == Verdict::Approaching;
        assert!(after_a_jump(true).iter().all(is_approaching));
        assert!(!after_a_jump(false).iter().any(is_approaching));
    }

    #[test]
    fn a_path_that_jumps_between_two_lengths_is_no_progress() {
        let mut fitness = Fitness::default();
        let mut next = |second| {
            let remaining_m = if second % 10 < 5 { 5.0 } else { 12.0 };
            fitness.update(&GOAL, &step(5.0, remaining_m))
        };
        let verdicts: Vec<Verdict> = (0..40).map(&mut next).collect();
        assert_eq!(verdicts[35], Verdict::Impossible);
    }

    #[test]
    fn an_obstacle_that_comes_and_goes_on_the_path_is_no_progress() {
        let mut fitness = Fitness::default();
        let mut next = |second| {
            let is_longer = second % 10 >= 5;
            let remaining_m = if is_longer { 5.6 } else { 5.0 };
            let mut step = step(5.0, remaining_m);
            // Each time another cell of it is discovered.
            let added_m = match second % 10 {
                5 => 0.6,
                0 if second > 0 => -0.6,
                _ => 0.0,
            };
            step.pursued.as_mut().unwrap().added_m = added_m;
            fitness.update(&GOAL, &step)
        };
        let verdicts: Vec<Verdict> = (0..40).map(&mut next).collect();
        assert_eq!(verdicts[25], Verdict::Receding);
        assert_eq!(verdicts[35], Verdict::Impossible);
    }

    #[test]
    fn a_robot_that_discovers_a_wall_while_it_drives_along_it_approaches() {
        let mut fitness = Fitness::default();
        // It discovers as much of the wall as it drives.
        for _ in 0..60 {
            let mut step = step(5.0, 5.0);
            step.pursued.as_mut().unwrap().added_m = 0.4;
            assert_eq!(fitness.update(&GOAL, &step), Verdict::Approaching);
        }
    }

    #[test]
    fn the_way_back_from_another_goal_is_not_counted_as_receding() {
        let mut fitness = Fitness::default();
        (0..3).for_each(|_| {
            fitness.update(&GOAL, &step(5.0, 5.0));
        });
        let elsewhere = Step {
            pursued: None,
            ..step(15.0, 15.0)
        };
        (0..50).for_each(|_| {
            fitness.update(&GOAL, &elsewhere);
        });
        assert!(fitness.stuck_s <= 3.0, "{fitness:?}");
        for remaining_m in (0..10).map(|second| 15.0 - f64::from(second)) {
            let verdict = fitness.update(&GOAL, &step(remaining_m, remaining_m));
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
