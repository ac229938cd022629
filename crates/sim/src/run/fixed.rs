//! Keys of goals and controllers that cannot change in a run, because a change would have no effect.

use super::state::State;
use crate::controllers::kind::{ControllerBase, ControllerKind};
use crate::goals::kind::GoalKind;
use crate::scenario::Scenario;
use base::error::InputError;
use base::placement::Placement;

impl State {
    /// The errors of a change that controllers and goals of this run would not notice: controllers and goals stay
    /// where they are, and agents keep the descriptions of goals that they have received.
    #[must_use]
    pub fn without_effect(&self, from: &Scenario, to: &Scenario) -> Vec<InputError> {
        let mut errors = Vec::new();
        for now in &to.controllers {
            let mut kinds = from.controllers.iter();
            if let Some(was) = kinds.find(|was| was.name == now.name) {
                errors.extend(of_start(was, now));
            }
        }
        for now in &to.goals {
            let mut kinds = from.goals.iter().enumerate();
            if let Some((number, was)) = kinds.find(|(_, was)| was.name == now.name) {
                errors.extend(of_placement(was, now));
                let keys = was.described().into_iter().zip(now.described());
                let owners = [(was, from), (now, to)].map(|(kind, of)| ("owner", owner(kind, of)));
                let [was_owner, is_owner] = owners;
                let keys = keys.chain([(was_owner, is_owner)]);
                let changed = keys.filter(|(was, now)| was != now && self.is_described(number));
                errors.extend(
                    changed.map(|((key, was), (_, is))| described(&now.name, key, (&was, is))),
                );
                errors.extend(self.of_timetable((number, was), now));
            }
        }
        let kinds = from.goals.iter().enumerate();
        errors.extend(kinds.filter_map(|kind| self.of_count(kind, to)));
        errors.extend(self.of_passage(from, to));
        errors
    }

    /// A number of goals below that of the goals that were issued: robots would continue to serve those removed.
    fn of_count(&self, (number, was): (usize, &GoalKind), to: &Scenario) -> Option<InputError> {
        let mut kinds = to.goals.iter();
        let now = kinds.find(|now| now.name == was.name);
        let now = now.map_or(0, |now| now.count);
        let tally = self.tally.goals.iter();
        let records = tally.flat_map(|goals| &goals.records);
        let goals = self.goals.all.iter().zip(records);
        let issued = goals.filter(|(goal, record)| {
            let is_issued = was.owner.is_some() && record.issued_at.is_some();
            usize::from(goal.kind) == number && is_issued
        });
        let issued = issued.map(|(goal, _)| goal.index + 1).max()?;
        (now < issued).then(|| {
            let allowed =
                format!("at least {issued}: controllers know the goals that were issued to them");
            let path = format!("goals.{}.count", was.name);
            InputError::new(path, Some(now.to_string()), allowed)
        })
    }

    /// Whether a goal of a kind was issued to a controller.
    fn is_described(&self, kind: usize) -> bool {
        let tally = self.tally.goals.iter();
        let records = tally.flat_map(|goals| &goals.records);
        let mut goals = self.goals.all.iter().zip(records);
        goals.any(|(goal, record)| usize::from(goal.kind) == kind && record.issued_to.is_some())
    }

    /// A timetable of goals that have all arrived.
    fn of_timetable(&self, (number, was): (usize, &GoalKind), now: &GoalKind) -> Vec<InputError> {
        let tally = self.tally.goals.iter();
        let records = tally.flat_map(|goals| &goals.records);
        let goals = self.goals.all.iter().zip(records);
        let mut goals = goals.filter(|(goal, _)| usize::from(goal.kind) == number);
        let is_complete = goals.all(|(_, record)| record.issued_at.is_some());
        // Goals that are added arrive by the new timetable.
        if !is_complete || was.count == 0 || now.count > was.count {
            return Vec::new();
        }
        let keys = ["arrive_s", "every_s"].into_iter();
        let times = keys.zip(was.timetable_s.into_iter().zip(now.timetable_s));
        let changed = times.filter(|(_, (was_s, is_s))| was_s.to_bits() != is_s.to_bits());
        let errors = changed.map(|(key, (was_s, is_s))| {
            let allowed = format!("{was_s}: all of these goals have arrived");
            InputError::new(
                format!("goals.{}.{key}", now.name),
                Some(is_s.to_string()),
                allowed,
            )
        });
        errors.collect()
    }
}

/// The kind of controllers that own goals of a kind, as text.
fn owner(kind: &GoalKind, scenario: &Scenario) -> String {
    let owner = kind
        .owner
        .and_then(|owner| scenario.controllers.get(usize::from(owner)));
    owner.map_or_else(|| "omitted".to_owned(), |owner| owner.name.clone())
}

/// A change of what agents know of goals.
fn described(name: &str, key: &str, (was, is): (&str, String)) -> InputError {
    let allowed = format!(
        "{was}, as when the first of these goals was issued: agents know them as they were"
    );
    InputError::new(format!("goals.{name}.{key}"), Some(is), allowed)
}

fn of_start(was: &ControllerKind, now: &ControllerKind) -> Option<InputError> {
    let (ControllerBase::Placed(before), ControllerBase::Placed(after)) = (&was.base, &now.base)
    else {
        return None;
    };
    let is_moved = is_moved(before, after, was.count.min(now.count));
    let allowed = "as it was for the controllers of the run: they do not move";
    is_moved.then(|| placement_error(format!("controllers.{}.start", now.name), allowed))
}

fn of_placement(was: &GoalKind, now: &GoalKind) -> Option<InputError> {
    let is_moved = is_moved(&was.placement, &now.placement, was.count.min(now.count));
    let allowed = "as it was for the goals of the run: they do not move";
    is_moved.then(|| placement_error(format!("goals.{}.placement", now.name), allowed))
}

fn placement_error(path: String, allowed: &str) -> InputError {
    InputError::new(path, Some("{...}".to_owned()), allowed.to_owned())
}

/// Whether the first `count` have other places. Fixed places for more of them may be added.
fn is_moved(was: &Placement, now: &Placement, count: u32) -> bool {
    let count = count as usize;
    match (was, now) {
        (Placement::Fixed { at_m: was, .. }, Placement::Fixed { at_m: now, .. }) => {
            was.iter().take(count).ne(now.iter().take(count))
        }
        _ => count > 0 && was != now,
    }
}
