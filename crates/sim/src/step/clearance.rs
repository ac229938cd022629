//! What the judge notes of a lane that controllers are to clear: what they state, and what was sent.

use super::decide::WorkerScratch;
use super::passage;
use crate::bodies::body_state::Status;
use crate::judge::clearance_tally::Progress;
use crate::run::state::State;
use crate::scenario::Scenario;

/// Reports a step to the judge, before messages are sent; returns whether anything was counted.
pub(super) fn observe(scenario: &Scenario, state: &mut State, workers: &[WorkerScratch]) -> bool {
    let Some(mut tally) = state.tally.clearance.take() else {
        return false;
    };
    for outgoing in workers.iter().flat_map(|worker| &worker.outbox) {
        tally.sent(&outgoing.message);
    }
    let bodies = state.ids.iter().zip(&state.body_states);
    let active = bodies.filter(|(_, body)| body.status == Status::Active);
    active.for_each(|(id, _)| tally.on_station(id.kind));
    let controllers = state.controllers.iter().enumerate();
    let working = controllers.filter(|(_, agent)| agent.participant.is_working(&state.body_states));
    let with_lane = working.filter(|(_, agent)| agent.controller.lane().is_some());
    let controllers = with_lane.map(|(controller, agent)| Progress {
        controller,
        is_clear: agent.stated,
        risk: agent.controller.lane_statement().map(|stated| stated.risk),
        has_open_marks: agent.controller.has_open_marks(),
        is_called_off: agent.controller.is_called_off(),
    });
    let remains = |controller: usize| state.remains(scenario, controller);
    let is_counted = tally.observe(state.tick, controllers, remains);
    state.tally.clearance = Some(tally);
    if is_counted {
        passage::conclude(scenario, state);
    }
    is_counted
}
