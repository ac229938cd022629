//! The goals of a run.

use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
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
    /// When those are issued that are not, and their numbers; the next one last.
    waiting: Vec<Reverse<(u64, usize)>>,
    /// How many controllers have refused a goal, by its number.
    refusals: BTreeMap<usize, usize>,
}

impl Goals {
    /// The goals of a run in which none was issued.
    pub(crate) fn new(all: Vec<Goal>) -> Self {
        let numbers = all.iter().enumerate();
        let numbers = numbers.map(|(number, goal)| (goal.id, number)).collect();
        let waiting = all.iter().enumerate();
        let mut waiting: Vec<_> = waiting
            .map(|(number, goal)| Reverse((goal.arrives_at, number)))
            .collect();
        waiting.sort_unstable();
        Self {
            all,
            numbers,
            waiting,
            refusals: BTreeMap::new(),
        }
    }

    /// Takes over which goals wait: those that were not issued until they arrive, and others as long as before, by their
    /// new numbers; and how often controllers have refused them.
    pub(crate) fn keep_waiting(
        &mut self,
        before: &Self,
        numbers: &BTreeMap<usize, usize>,
        is_issued: impl Fn(usize) -> bool,
    ) {
        self.waiting
            .retain(|Reverse((_, number))| !is_issued(*number));
        for Reverse((at, was)) in &before.waiting {
            if let Some(number) = numbers.get(was).filter(|number| is_issued(**number)) {
                self.issue_again(*number, *at);
            }
        }
        let refusals = before.refusals.iter();
        self.refusals = refusals
            .filter_map(|(was, count)| Some((*numbers.get(was)?, *count)))
            .collect();
    }

    /// Which goals wait until when, and how often controllers have refused them.
    pub(crate) fn add_issues_to(&self, hash: &mut Hash) {
        for Reverse((at, number)) in &self.waiting {
            (*at, *number).add_to(hash);
        }
        for (number, count) in &self.refusals {
            (*number, *count).add_to(hash);
        }
    }

    /// Notes that a goal is issued again at a later time.
    pub(crate) fn issue_again(&mut self, number: usize, at: u64) {
        let due = Reverse((at, number));
        let place = self.waiting.partition_point(|waiting| *waiting < due);
        self.waiting.insert(place, due);
    }

    /// Notes that a controller refuses a goal; returns how often that has happened.
    pub(crate) fn refuse(&mut self, number: usize) -> usize {
        let refusals = self.refusals.entry(number).or_default();
        *refusals += 1;
        *refusals
    }

    /// How many controllers have refused a goal.
    pub(crate) fn refusals(&self, number: usize) -> usize {
        self.refusals.get(&number).copied().unwrap_or(0)
    }

    /// Whether a goal is yet to be issued, or to be issued again.
    pub(crate) fn is_waiting(&self, number: usize) -> bool {
        self.waiting
            .iter()
            .any(|Reverse((_, waiting))| *waiting == number)
    }

    /// The numbers of the goals that are issued by now, the next one first.
    pub(crate) fn due(&self, now: u64) -> impl Iterator<Item = usize> {
        let waiting = self.waiting.iter().rev();
        let due = waiting.take_while(move |Reverse((at, _))| *at <= now);
        due.map(|Reverse((_, number))| *number)
    }

    /// Removes a goal that is issued by now from those that are yet to be issued.
    #[inline]
    pub(crate) fn next_arrival(&mut self, now: u64) -> Option<usize> {
        let next = self.has_arrival(now).then(|| self.waiting.pop());
        next.flatten().map(|Reverse((_, number))| number)
    }

    /// Whether a goal that arrives by now is yet to be issued.
    #[inline]
    pub(crate) fn has_arrival(&self, now: u64) -> bool {
        let next = self.waiting.last();
        next.is_some_and(|Reverse((at, _))| *at <= now)
    }

    /// The number of the goal of an id.
    pub(crate) fn number(&self, id: GoalId) -> Option<usize> {
        self.numbers.get(&id).copied()
    }
}
