//! When a run is over.

use super::moment::Moment;
use crate::bodies::body_state::Status;

/// A reason for which a run is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EndRule {
    /// All targets are found.
    Complete,
    /// The time limit is reached.
    TimeLimit,
    /// No robot can move.
    NoRobotActive,
}

impl EndRule {
    const ALL: [Self; 3] = [Self::Complete, Self::TimeLimit, Self::NoRobotActive];

    fn holds(self, moment: &Moment) -> bool {
        let mut bodies = moment.body_states.iter();
        match self {
            Self::Complete => moment.tally.complete_at.is_some(),
            Self::TimeLimit => moment.tick >= moment.scenario.steps,
            Self::NoRobotActive => !bodies.any(|body| body.status == Status::Active),
        }
    }
}

impl Moment<'_> {
    /// Whether the run is over: one of the rules holds.
    pub(crate) fn is_over(&self) -> bool {
        EndRule::ALL.iter().any(|rule| rule.holds(self))
    }
}
