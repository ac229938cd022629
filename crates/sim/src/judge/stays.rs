//! Since when robots are at goals that take time, whatever they announce.

use super::goal_moment::GoalMoment;
use crate::bodies::body_state::Status;
use base::hashed::Hashed;

/// The robots that are at goals whose service takes time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stays(Vec<Stay>);

#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
struct Stay {
    goal: usize,
    robot: usize,
    /// The step in which it came there.
    since: u64,
}

impl base::hashed::Hashed for Stays {
    fn add_to(&self, hash: &mut base::hash::Hash) {
        self.0.add_to(hash);
    }
}

impl Stays {
    /// Notes where robots are in a step, and at which goals of those for which `is_issued` returns true.
    pub(super) fn follow(&mut self, moment: &GoalMoment, is_issued: impl Fn(usize) -> bool) {
        let before = std::mem::take(&mut self.0);
        for (number, goal) in moment.goals.all.iter().enumerate() {
            let takes_time = moment.scenario.goals[usize::from(goal.kind)].service_steps > 0;
            if !takes_time || !is_issued(number) {
                continue;
            }
            for (robot, body_state) in moment.body_states.iter().enumerate() {
                if body_state.status == Status::Active && moment.is_near(robot, goal) {
                    let mut known = before.iter();
                    let same = known.find(|stay| stay.goal == number && stay.robot == robot);
                    let since = same.map_or(moment.tick, |stay| stay.since);
                    self.0.push(Stay {
                        goal: number,
                        robot,
                        since,
                    });
                }
            }
        }
    }

    /// The stays at goals and of robots that have other numbers now; `robot` and `goal` return them.
    pub(super) fn renumbered(
        &self,
        robot: impl Fn(usize) -> Option<usize>,
        goal: impl Fn(usize) -> Option<usize>,
    ) -> Self {
        let kept = self.0.iter().filter_map(|stay| {
            Some(Stay {
                goal: goal(stay.goal)?,
                robot: robot(stay.robot)?,
                since: stay.since,
            })
        });
        Self(kept.collect())
    }

    /// The step in which a robot arrived at a goal where it still is.
    pub(super) fn since(&self, robot: usize, goal: usize) -> Option<u64> {
        let mut stays = self.0.iter();
        let stay = stays.find(|stay| stay.goal == goal && stay.robot == robot);
        stay.map(|stay| stay.since)
    }
}
