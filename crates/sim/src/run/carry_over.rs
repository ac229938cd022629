//! Which robots stay when a run continues with another scenario, and their new numbers.

use super::state::State;
use crate::bodies::body_state::BodyState;
use crate::scenario::Scenario;
use brain::{About, AgentId, ReceivedMessage, Receiver};
use std::collections::BTreeMap;

/// For each robot of `next` its number in `before`, by the name of its kind and its index; `None`
/// for one that is added.
pub(super) fn previous_numbers(
    before: &State,
    from: &Scenario,
    next: &State,
    to: &Scenario,
) -> Vec<Option<usize>> {
    let old = before.ids.iter().enumerate();
    let old = old.map(|(robot, id)| ((from.kind_of(*id).name.as_str(), id.index), robot));
    let old: BTreeMap<(&str, u32), usize> = old.collect();
    let was = |id: &AgentId| old.get(&(to.kind_of(*id).name.as_str(), id.index)).copied();
    next.ids.iter().map(was).collect()
}

/// For each controller of `next` its number in `before`, as [`previous_numbers`].
pub(super) fn previous_controllers(
    before: &State,
    from: &Scenario,
    next: &State,
    to: &Scenario,
) -> Vec<Option<usize>> {
    let name = |scenario: &Scenario, id: AgentId| {
        let kind = scenario.controller_kind_of(id);
        (kind.name.clone(), id.index)
    };
    let old = before.controllers.iter().enumerate();
    let old = old.map(|(number, agent)| (name(from, agent.participant.id), number));
    let old: BTreeMap<(String, u32), usize> = old.collect();
    let ids = next.controllers.iter().map(|agent| agent.participant.id);
    ids.map(|id| old.get(&name(to, id)).copied()).collect()
}

/// Whether none of `count` robots or controllers was removed, and none added.
pub(super) fn is_same_team(count: usize, old: &[Option<usize>]) -> bool {
    old.len() == count && old.iter().all(Option::is_some)
}

/// The body states of the robots that are removed, each with the key of its kind.
pub(super) fn removed(
    (before, from): (&State, &Scenario),
    old: &[Option<usize>],
) -> Vec<(u32, BodyState)> {
    let mut stays = vec![false; before.robots()];
    old.iter().flatten().for_each(|robot| stays[*robot] = true);
    let keys = before.ids.iter().map(|id| from.kind_of(*id).key);
    let body_states = keys.zip(&before.body_states).zip(stays);
    body_states
        .filter_map(|((key, body_state), stays)| (!stays).then_some((key, body_state.clone())))
        .collect()
}

/// Old and new ids of the robots that stay: kinds of robots are renumbered when a kind before them
/// is added or removed.
pub(super) fn new_ids(
    before: &State,
    next: &State,
    old: &[Option<usize>],
) -> BTreeMap<AgentId, AgentId> {
    let pairs = old.iter().zip(&next.ids);
    pairs
        .filter_map(|(was, id)| Some((before.ids[(*was)?], *id)))
        .collect()
}

/// Old and new ids of the controllers that stay.
pub(super) fn new_controller_ids(
    before: &State,
    next: &State,
    old: &[Option<usize>],
) -> BTreeMap<AgentId, AgentId> {
    let pairs = old.iter().zip(&next.controllers);
    let pairs = pairs.filter_map(|(was, agent)| Some((before.controllers.get((*was)?)?, agent)));
    pairs
        .map(|(was, agent)| (was.participant.id, agent.participant.id))
        .collect()
}

/// Renumbers the ids in a message in transit; returns false if a robot or item that it refers to by
/// name no longer exists.
pub(super) fn renumber_message(
    message: &mut ReceivedMessage,
    ids: &BTreeMap<AgentId, AgentId>,
    from: &Scenario,
    to: &Scenario,
) -> bool {
    let Some(sender) = ids.get(&message.from) else {
        return false;
    };
    let receiver = message
        .message
        .to
        .agent()
        .and_then(|to| ids.get(&to).copied());
    let receiver = Receiver::from(receiver);
    let is_of_economy = message.message.about.is_of_economy();
    if is_of_economy && (*sender, receiver) != (message.from, message.message.to) {
        // It belongs to leases between agents that had other ids.
        return false;
    }
    message.from = *sender;
    message.message.to = receiver;
    let About::Item {
        kind, provenance, ..
    } = &mut message.message.about
    else {
        return true;
    };
    let Some(looker) = ids.get(&provenance.observer) else {
        return false;
    };
    provenance.observer = *looker;
    let Some(was) = from.items.get(usize::from(*kind)) else {
        // It names no kind that existed: it stays as it is.
        return usize::from(*kind) >= to.items.len();
    };
    let now = (0..).zip(&to.items).find(|(_, now)| now.name == was.name);
    now.map(|(number, _)| *kind = number).is_some()
}
