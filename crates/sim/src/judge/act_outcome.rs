//! The outcome of what robots did to items.

use super::act_tally::ActTally;
use super::moment::Moment;
use crate::world::items::CompletedBy;
use brain::ActKind;

/// What robots did to the targets of a run, in a scenario where they can do more than detect them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ActOutcome {
    /// Targets that were marked.
    pub marked: u32,
    /// Marked places without a target.
    pub false_marks: u32,
    /// Targets that were confirmed.
    pub confirmed: u32,
    /// Confirmed places without a target.
    pub false_confirmations: u32,
    /// Targets that a charge destroyed.
    pub neutralised: u32,
    /// Targets that are not complete.
    pub left: u32,
    /// Robots that items destroyed, including those that were removed.
    pub robots_lost: u32,
    /// Targets that no flying robot has marked.
    pub unmarked_from_air: u32,
    /// Of these, the targets that a ground robot has detected or come too near to.
    pub met_unmarked: u32,
}

impl ActOutcome {
    pub(super) fn of(moment: &Moment, tally: &ActTally) -> Self {
        let count = |places: usize| u32::try_from(places).unwrap_or(u32::MAX);
        let mut outcome = Self {
            false_marks: count(tally.false_marks.len()),
            false_confirmations: count(tally.false_confirmations.len()),
            left: moment.left(),
            robots_lost: tally.robots_lost,
            ..Self::default()
        };
        for (item, _) in targets(moment) {
            let acts = tally.of(item);
            let is_done = |kind| u32::from(acts.first(kind).is_some());
            outcome.marked += is_done(ActKind::Mark);
            outcome.confirmed += is_done(ActKind::Confirm);
            outcome.neutralised += is_done(ActKind::Neutralise);
            outcome.unmarked_from_air += u32::from(!acts.is_marked_from_air);
            outcome.met_unmarked += u32::from(!acts.is_marked_from_air && acts.is_met);
        }
        outcome
    }
}

impl Moment<'_> {
    /// Targets that are not complete: neither destroyed nor, as their kind demands, detected or confirmed.
    pub(super) fn left(&self) -> u32 {
        let left = targets(self).filter(|(item, kind)| !self.is_complete(*item, *kind));
        u32::try_from(left.count()).unwrap_or(u32::MAX)
    }

    fn is_complete(&self, item: u32, kind: u16) -> bool {
        let confirmed = |acts: &ActTally| acts.of(item).first(ActKind::Confirm).is_some();
        self.items.is_gone(item)
            || match self.scenario.items[usize::from(kind)].completed_by {
                CompletedBy::Detected => self.tally.is_detected(item),
                CompletedBy::Confirmed => self.tally.acts.as_deref().is_some_and(confirmed),
                CompletedBy::Neutralised => false,
            }
    }
}

/// The numbers of all targets and of their kinds.
fn targets(moment: &Moment) -> impl Iterator<Item = (u32, u16)> {
    let kinds = (0..).zip(moment.items.kinds());
    kinds.filter(|(_, kind)| moment.scenario.items[usize::from(*kind)].is_target)
}
