//! Continuing a run with another scenario.

use super::carry_over::{
    is_same_team, new_controller_ids, new_ids, previous_controllers, previous_numbers, removed,
    renumber_message,
};
use super::placing::{NoRoom, draws};
use super::state::State;
use crate::bodies::Layer;
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::kind::Kind;
use crate::scenario::Scenario;
use crate::world::items::Item;
use base::placement::{DiscIndex, EntityClass, PlacementError, TeamPlacementError};
use brain::AgentId;
use std::collections::BTreeMap;

/// Whether the place of a robot is still valid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Start {
    /// It stays where it was, with the same geometry.
    Unchanged,
    /// It stays, but its shape or that of the world changed: the place must still be free.
    MustBeFree,
    /// It is added, and can start elsewhere.
    New,
}

impl State {
    /// The run as it continues with another scenario of the same step and the same size and sides
    /// of the world.
    ///
    /// Robots and items that are in both, by the names of their kinds and their indices, stay as
    /// they are, and so do controllers and goals; others are added where they would start, or removed. A robot whose brain, body or
    /// sensors changed gets a new agent, and its speed is limited at once to what its drive now
    /// allows. Of a battery with another capacity, what was not used so far is left. Messages in
    /// transit are lost if the team changes. The cost of robots that are removed stays part of the
    /// outcome. A run that meets a new condition of its end is complete now.
    ///
    /// # Errors
    /// If there is no room for what is added, or for what stays where something else is now.
    pub fn changed(&self, from: &Scenario, to: &Scenario) -> Result<Self, NoRoom> {
        let mut next = Self::new(to, self.seed, self.run)?;
        (next.tick, next.decisions) = (self.tick, self.decisions);
        next.convoy.clone_from(&self.convoy);
        let old = previous_numbers(self, from, &next, to);
        let old_controllers = previous_controllers(self, from, &next, to);
        let mut ids = new_ids(self, &next, &old);
        ids.extend(new_controller_ids(self, &next, &old_controllers));
        let starts = next.keep_robots(self, &old, from, to);
        for agent in &mut next.agents {
            agent.renumber_robots(&ids);
        }
        next.keep_controllers(self, to, &old_controllers, &ids);
        next.fail_named(to);
        next.change_service((self, from), to, &old);
        next.make_room(to, &starts)?;
        let kept = next.keep_items(self, from, to)?;
        let removed = removed((self, from), &old);
        next.tally = self
            .tally
            .continued((to, &next.items), &kept, (&removed, &ids));
        next.keep_goals((self, from), to, &old, &ids);
        let forgets =
            |number: &usize| !has_same_ids(&ids) || !old_controllers.contains(&Some(*number));
        let forgetful: Vec<usize> = (0..self.controllers.len()).filter(forgets).collect();
        let lease = from.longest_lease().max(to.longest_lease());
        next.reissue_forgotten(self, to, &forgetful, lease);
        next.note_forgotten(self);
        next.tally.complete_at = next.moment(to).completed_at(self.tally.complete_at);
        if is_same_team(self.robots(), &old)
            && is_same_team(self.controllers.len(), &old_controllers)
        {
            // Kinds are sorted by name, so that receivers keep their numbers.
            next.channel = self.channel.clone();
            next.channel
                .retain(|message| renumber_message(message, &ids, from, to));
        }
        Ok(next)
    }

    /// Takes over controllers that stay, each from its `old` number.
    fn keep_controllers(
        &mut self,
        before: &Self,
        to: &Scenario,
        old: &[Option<usize>],
        ids: &BTreeMap<AgentId, AgentId>,
    ) {
        let has_same_ids = has_same_ids(ids);
        let is_removed = |id: AgentId| id.is_controller() && !ids.contains_key(&id);
        for (agent, was) in self.controllers.iter_mut().zip(old) {
            if let Some(was) = was.map(|was| &before.controllers[was]) {
                let settings = &to.controller_kind_of(agent.participant.id).settings;
                // One that is switched off does not know how long.
                let knows = has_same_ids && was.participant.is_working(&before.body_states);
                agent.take_over(was, settings, knows);
                agent.controller.forget_peers(is_removed);
                agent.participant.renumber(ids);
            }
            for other in &before.controllers {
                agent.controller.join(&other.controller);
            }
        }
    }

    /// Takes over robots that stay, each from its `old` number.
    fn keep_robots(
        &mut self,
        before: &Self,
        old: &[Option<usize>],
        from: &Scenario,
        to: &Scenario,
    ) -> Vec<Start> {
        let is_same_ground = from.solids() == to.solids();
        let mut starts = vec![Start::New; self.robots()];
        for (robot, start) in starts.iter_mut().enumerate() {
            let id = self.ids[robot];
            let Some(was) = old[robot] else {
                continue;
            };
            let old_kind = from.kind_of(before.ids[was]);
            let kind = to.kind_of(id);
            self.discs[robot].centre = before.discs[was].centre;
            self.orientations[robot] = before.orientations[was];
            self.agents[robot].take_over_queue(&before.agents[was], kind);
            self.body_states[robot] = kept_body_state(&before.body_states[was], kind, to);
            if has_same_agent(old_kind, kind) {
                self.agents[robot].take_over(&before.agents[was]);
            }
            let is_same =
                kind.radius_m.total_cmp(&old_kind.radius_m).is_eq() && kind.layer == old_kind.layer;
            let is_placed = self.body_states[robot].is_external() || is_same_ground && is_same;
            *start = if is_placed {
                Start::Unchanged
            } else {
                Start::MustBeFree
            };
        }
        starts
    }

    /// Moves added robots elsewhere if their place is taken by now.
    fn make_room(&mut self, scenario: &Scenario, starts: &[Start]) -> Result<(), NoRoom> {
        let draws = draws(scenario, self.seed, self.run, EntityClass::Robots);
        let mut crowd = self.crowd(scenario);
        for (robot, start) in starts.iter().enumerate() {
            if *start == Start::Unchanged {
                continue;
            }
            let (id, centre) = (self.ids[robot], self.discs[robot].centre);
            let number = usize::from(id.kind);
            let kind = scenario.kind_of(id);
            crowd.remove(number, centre);
            let is_free = |place| {
                scenario.is_free(place, kind.radius_m, kind.layer) && !crowd.is_taken(number, place)
            };
            let place = match start {
                _ if is_free(centre) => Ok(centre),
                Start::New => kind.start.place(&draws, kind.entity(id.index), is_free),
                _ => Err(PlacementError::Taken),
            };
            let place = place.map(|place| scenario.home(place));
            let place = place.map_err(|why| TeamPlacementError {
                kind: id.kind,
                index: id.index,
                why,
            })?;
            crowd.add(number, place);
            self.discs[robot].centre = place;
        }
        Ok(())
    }

    /// Where the robots of each kind are.
    fn crowd(&self, scenario: &Scenario) -> DiscIndex {
        let kinds = scenario.kinds.iter();
        let discs = kinds.map(|kind| (kind.layer as u8, kind.radius_m));
        let mut crowd = DiscIndex::new(discs, scenario.torus);
        for (id, disc) in self.ids.iter().zip(&self.discs) {
            crowd.add(usize::from(id.kind), disc.centre);
        }
        crowd
    }

    /// Takes over items that stay, and the detections of them in transit; returns their numbers now and before.
    fn keep_items(
        &mut self,
        before: &Self,
        from: &Scenario,
        to: &Scenario,
    ) -> Result<Vec<(usize, usize)>, NoRoom> {
        let old: BTreeMap<_, _> = before.items.named(&from.items).collect();
        let named = self.items.named(&to.items);
        let kept = named.filter_map(|(name, item)| Some((item.number, *old.get(&name)?)));
        let kept: Vec<(usize, Item)> = kept.collect();
        self.items.keep(&kept);
        if from.solids() != to.solids() {
            self.check_items(to)?;
        }
        let numbers = kept.iter().map(|(now, item)| (*now, item.number));
        let numbers: Vec<(usize, usize)> = numbers.collect();
        let new_numbers = numbers.iter().map(|(now, was)| (*was, *now)).collect();
        for agent in &mut self.agents {
            agent.renumber_items(&new_numbers);
        }
        Ok(numbers)
    }

    /// Items lie where something else is now.
    fn check_items(&self, scenario: &Scenario) -> Result<(), NoRoom> {
        let mut items = self.items.named(&scenario.items);
        let is_taken = |item: &Item| !scenario.is_free(item.place, 0.0, Layer::Ground);
        let taken = items.find(|(_, item)| is_taken(item));
        taken.map_or(Ok(()), |((name, index), _)| {
            Err(no_room(scenario, name, index))
        })
    }
}

fn no_room(scenario: &Scenario, name: &str, index: u32) -> NoRoom {
    let kinds = (0..).zip(&scenario.items);
    let kind = kinds.into_iter().find(|(_, kind)| kind.name == name);
    NoRoom::Item {
        kind: kind.map_or(0, |(number, _)| number),
        index,
        why: PlacementError::Taken,
    }
}

fn kept_body_state(body_state: &BodyState, kind: &Kind, to: &Scenario) -> BodyState {
    let is_used_up = kind
        .battery
        .is_some_and(|battery| body_state.energy_j >= battery.capacity_j);
    let status = match body_state.status {
        Status::Broken => Status::Broken,
        status if body_state.is_external() => status,
        _ if is_used_up => Status::Empty,
        _ => Status::Active,
    };
    let drive = &kind.drive;
    let motion = drive.executable(body_state.motion(), to.max_speed_factor());
    let mut kept = BodyState {
        speed_m_s: motion.speed_m_s,
        turn_rate_rad_s: motion.turn_rate_rad_s,
        status,
        ..body_state.clone()
    };
    if let Some(external) = kept.external_mut() {
        external.number_sensors(kind);
    }
    kept
}

/// Whether robots keep their agents, and only what their brains know about others changes.
fn has_same_agent(from: &Kind, to: &Kind) -> bool {
    from.brain.spec() == to.brain.spec()
        && from.brain.body().is_same_but_for_others(to.brain.body())
        && from.sensors == to.sensors
        && from.needs_backlog() == to.needs_backlog()
}

/// Whether no agent has another id: controllers then keep their memory.
fn has_same_ids(ids: &BTreeMap<AgentId, AgentId>) -> bool {
    ids.iter().all(|(was, now)| was == now)
}
