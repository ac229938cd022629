//! What the judge of goals sees of a step.

use super::events::EventKind;
use crate::bodies::body_state::BodyState;
use crate::goals::placed::{Goal, Goals};
use crate::scenario::Scenario;
use base::geometry::Disc;
use brain::AgentId;

/// A step of a run, as the judge of goals sees it: what robots decided, and where they decided it.
#[derive(Clone, Copy)]
pub(crate) struct GoalMoment<'a> {
    pub(crate) scenario: &'a Scenario,
    pub(crate) tick: u64,
    pub(crate) goals: &'a Goals,
    pub(crate) ids: &'a [AgentId],
    pub(crate) discs: &'a [Disc],
    pub(crate) body_states: &'a [BodyState],
}

impl GoalMoment<'_> {
    /// Whether a robot is at a goal, or will be there in this step.
    pub(super) fn is_near(&self, robot: usize, goal: &Goal) -> bool {
        let centre = self.discs[robot].centre;
        let drive = &self.scenario.kind_of(self.ids[robot]).drive;
        let within_m = self.scenario.goals[usize::from(goal.kind)].within_m;
        let speed_m_s = drive.executed_m_s(drive.max_speed_m_s);
        let reach_m = within_m + speed_m_s * self.scenario.step_s;
        let there = self.scenario.image(centre, goal.at);
        centre.to(there).length_squared() <= reach_m * reach_m
    }

    /// The event that a robot served a goal, by their numbers.
    pub(super) fn service(&self, robot: usize, goal: usize) -> EventKind {
        let (by, goal) = (self.ids[robot], &self.goals.all[goal]);
        let goal = (goal.kind, goal.index);
        EventKind::Served { goal, by }
    }

    /// Whether a stay at a goal was long enough on a clock that may be fast.
    #[expect(clippy::cast_precision_loss, reason = "steps are at most 1e8")]
    pub(super) fn is_long_enough(&self, goal: &Goal, steps: u64) -> bool {
        let needed = self.scenario.goals[usize::from(goal.kind)].service_steps;
        steps as f64 >= needed as f64 * (1.0 - self.scenario.clocks.max_drift)
    }

    /// Whether a goal has expired.
    pub(super) fn is_late(&self, goal: &Goal, issued_at: u64) -> bool {
        let kind = &self.scenario.goals[usize::from(goal.kind)];
        is_late(kind.deadline_steps, issued_at, self.tick)
    }
}

/// Whether the deadline of a goal is over.
pub(crate) fn is_late(deadline_steps: Option<u64>, issued_at: u64, now: u64) -> bool {
    deadline_steps.is_some_and(|steps| now > issued_at.saturating_add(steps))
}
