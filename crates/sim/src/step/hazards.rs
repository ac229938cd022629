//! Items that destroy robots on the ground that come too near to them.

use crate::bodies::Layer;
use crate::bodies::body_state::Status;
use crate::judge::events::EventLog;
use crate::run::state::State;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::noise::share;

/// Destroys robots that are too near to an item at the end of their move, in their order; returns whether the judge
/// counted anything. External bodies are not destroyed.
pub(super) fn detonate(scenario: &Scenario, state: &mut State, events: &EventLog) -> bool {
    let mut is_counted = false;
    let Some(max_hazard_m) = scenario.max_hazard_m() else {
        return false;
    };
    for robot in 0..state.robots() {
        let body_state = &state.body_states[robot];
        let is_on_ground = scenario.kind_of(state.ids[robot]).layer == Layer::Ground;
        if is_on_ground && body_state.status == Status::Active && !body_state.is_external() {
            let disc = state.discs[robot];
            let near = state
                .items
                .within(disc.centre, max_hazard_m + disc.radius_m);
            for item in near {
                is_counted |= state.encounter(scenario, robot, item, events);
            }
        }
    }
    is_counted
}

impl State {
    /// Lets a robot meet an item, which may destroy it; returns whether the judge counted anything.
    fn encounter(
        &mut self,
        scenario: &Scenario,
        robot: usize,
        item: u32,
        events: &EventLog,
    ) -> bool {
        let kind = &scenario.items[usize::from(self.items.kind(item))];
        let disc = self.discs[robot];
        let place = scenario.image(disc.centre, self.items.place(item));
        let gap_m = disc.centre.to(place).length() - disc.radius_m;
        let Some(hazard) = kind.hazard.filter(|hazard| gap_m <= hazard.radius_m) else {
            return false;
        };
        let is_active = self.body_states[robot].status == Status::Active;
        self.tally.met(item);
        // The same draw in each step: one for each robot and item.
        let index = self.items.thing(item).index;
        let words = self.noises[robot].words(NoisePurpose::Hazard as u32, kind.key.into(), index);
        if !is_active || share(words[0]) >= hazard.destroy_probability {
            return false;
        }
        let body_state = &mut self.body_states[robot];
        body_state.status = Status::Broken;
        (body_state.speed_m_s, body_state.turn_rate_rad_s) = (0.0, 0.0);
        self.tally
            .lost((self.ids[robot], item), (self.tick, &self.items), events);
        if hazard.detonates {
            self.items.remove(item);
        }
        true
    }
}
