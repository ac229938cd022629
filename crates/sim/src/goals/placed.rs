//! The goals of a run.

use base::geometry::Point;
use brain::GoalId;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// One goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Goal {
    pub(crate) id: GoalId,
    /// Number of its kind.
    pub(crate) kind: u8,
    pub(crate) index: u32,
    pub(crate) at: Point,
    /// The step in which it arrives.
    pub(crate) arrives_at: u64,
}

/// The goals of a run, in the order of their kinds and indices.
#[derive(Debug, Clone, Default)]
pub(crate) struct Goals {
    pub(crate) all: Vec<Goal>,
    numbers: BTreeMap<GoalId, usize>,
    /// The numbers of those that are yet to be issued, the next one last.
    waiting: Vec<usize>,
}

impl Goals {
    /// The goals of a run in which none was issued.
    pub(crate) fn new(all: Vec<Goal>) -> Self {
        let numbers = all.iter().enumerate();
        let numbers = numbers.map(|(number, goal)| (goal.id, number)).collect();
        let waiting = (0..all.len()).collect();
        let mut goals = Self {
            all,
            numbers,
            waiting: Vec::new(),
        };
        goals.wait(waiting);
        goals
    }

    /// Notes which goals are yet to be issued.
    pub(crate) fn wait(&mut self, mut waiting: Vec<usize>) {
        waiting.sort_by_key(|number| Reverse((self.all[*number].arrives_at, *number)));
        self.waiting = waiting;
    }

    /// Removes a goal that arrives by now from those that are yet to be issued.
    #[inline]
    pub(crate) fn next_arrival(&mut self, now: u64) -> Option<usize> {
        self.has_arrival(now).then(|| self.waiting.pop()).flatten()
    }

    /// Whether a goal that arrives by now is yet to be issued.
    #[inline]
    pub(crate) fn has_arrival(&self, now: u64) -> bool {
        let next = self.waiting.last();
        next.is_some_and(|next| self.all[*next].arrives_at <= now)
    }

    /// The number of the goal of an id.
    pub(crate) fn number(&self, id: GoalId) -> Option<usize> {
        self.numbers.get(&id).copied()
    }
}
