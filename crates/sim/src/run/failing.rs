//! Robots and controllers that fail, at random times or because the scenario names them.

use super::state::State;
use crate::bodies::body_state::Status;
use crate::failures::fails;
use crate::scenario::Scenario;

impl State {
    /// Lets those fail that the scenario names. External bodies do not fail.
    pub(super) fn fail_named(&mut self, scenario: &Scenario) {
        for (id, body_state) in self.ids.iter().zip(&mut self.body_states) {
            let is_named = scenario.kind_of(*id).failed.contains(&id.index);
            if is_named && !body_state.is_external() {
                body_state.status = Status::Broken;
            }
        }
        for agent in &mut self.controllers {
            let participant = &mut agent.participant;
            let kind = scenario.controller_kind_of(participant.id);
            participant.has_failed |= kind.failed.contains(&participant.id.index);
        }
    }

    /// Lets those fail whose time has come by the end of a step. External bodies do not fail.
    pub(crate) fn fail(&mut self, scenario: &Scenario) {
        let now = (self.tick, scenario.step_s);
        for (robot, body_state) in self.body_states.iter_mut().enumerate() {
            let kind = scenario.kind_of(self.ids[robot]);
            let is_on = body_state.status == Status::Active && !body_state.is_external();
            let mean_s = kind.mean_time_between_failures_s.filter(|_| is_on);
            if mean_s.is_some_and(|mean_s| fails(self.noises[robot], mean_s, now)) {
                body_state.status = Status::Broken;
            }
        }
        for agent in &mut self.controllers {
            let participant = &mut agent.participant;
            let kind = scenario.controller_kind_of(participant.id);
            let mean_s = kind.mean_time_between_failures_s;
            participant.has_failed |=
                mean_s.is_some_and(|mean_s| fails(participant.noise, mean_s, now));
        }
    }
}
