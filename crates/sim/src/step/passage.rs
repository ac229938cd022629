//! A controller's statement about a lane takes effect: vehicles begin to pass a lane that has been declared clear.

use crate::judge::conclusion_tally::{ConclusionTally, StatedClearance};
use crate::passage::convoy::Convoy;
use crate::run::controller::ControllerAgent;
use crate::run::state::State;
use crate::scenario::Scenario;
use economy::ClearedShare;

/// Notes what has been stated of the lane in this step beside the risk, with the truth, and sends the vehicles if it has
/// been declared clear.
pub(super) fn conclude(scenario: &Scenario, state: &mut State) {
    let Some((is_clear, agent)) = stating(state) else {
        return;
    };
    let Some(conclusion) = agent.controller.lane_conclusion() else {
        return;
    };
    let cleared = conclusion.cleared.iter();
    let cleared = cleared.map(|share| stated(share, scenario, state));
    let mut tally = ConclusionTally {
        cleared: cleared.collect(),
        passage: conclusion.passage,
        mines_on_path: 0,
    };
    if let Some((passage, planned)) = scenario.passage.zip(tally.passage.as_ref()) {
        let convoy = Convoy::new(&passage, planned);
        let mines = convoy.mines(scenario, &state.items);
        tally.mines_on_path = u32::try_from(mines.len()).unwrap_or(u32::MAX);
        state.convoy = is_clear.then(|| Box::new(convoy));
    }
    state.tally.conclusion = Some(Box::new(tally));
}

/// The controller whose statement counts, and whether it has declared the lane clear: the first that declares it, or the
/// last that gives it up.
fn stating(state: &State) -> Option<(bool, &ControllerAgent)> {
    let controllers = state.controllers.iter();
    let working = controllers.filter(|agent| agent.participant.is_working(&state.body_states));
    let stated = working.filter_map(|agent| {
        agent.controller.lane()?;
        Some((agent.stated?, agent))
    });
    let mut last = None;
    for each @ (is_clear, _) in stated {
        last = Some(each);
        if is_clear {
            break;
        }
    }
    last
}

fn stated(share: &ClearedShare, scenario: &Scenario, state: &State) -> StatedClearance {
    let [all, left] = state.mines_of(scenario, share.kind);
    StatedClearance {
        kind: share.kind,
        stated: share.share,
        low: share.low,
        high: share.high,
        truth: if all == 0 {
            1.0
        } else {
            1.0 - f64::from(left) / f64::from(all)
        },
    }
}
