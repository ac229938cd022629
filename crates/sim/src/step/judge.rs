//! Judge: counts what robots found, and their false alarms.

use super::decide::WorkerScratch;
use super::pending_decisions::PendingDecisions;
use crate::run::state::State;
use crate::scenario::Scenario;

/// Marks the items that robots detected in this step as found.
pub(crate) fn judge(
    scenario: &Scenario,
    state: &mut State,
    decisions: &PendingDecisions,
    workers: &[WorkerScratch],
) {
    count(
        scenario,
        state,
        (decisions.false_alarms, &decisions.sightings),
    );
    for worker in workers {
        count(
            scenario,
            state,
            (
                worker.sensing.detections.false_alarms,
                &worker.sensing.detections.sightings,
            ),
        );
    }
}

fn count(scenario: &Scenario, state: &mut State, (false_alarms, sightings): (u64, &[u32])) {
    state.tally.false_alarms += false_alarms;
    for item in sightings {
        state.find(scenario, *item);
    }
}
