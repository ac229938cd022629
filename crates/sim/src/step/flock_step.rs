//! A step of point robots that only flock.
//!
//! None is ever in another's way, so each moves as soon as it has decided: its data is read from
//! memory and written there once.

use super::act::Moved;
use super::flocks::{AT_ONCE, Flocks, PER_TASK};
use super::plan::{Body, planned};
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::path::Orientation;
use crate::run::agent::Agent;
use crate::run::state::State;
use crate::scenario::Scenario;
use base::geometry::Disc;
use base::noise::Noise;
use brain::{AgentId, Motion};
use rayon::prelude::*;

/// Consecutive point robots, from the first on.
type Points<'a> = (
    usize,
    (
        (&'a [AgentId], &'a [Noise]),
        (&'a mut [Disc], &'a mut [Orientation]),
        (&'a mut [BodyState], &'a mut [Agent]),
    ),
);

/// Lets all point robots decide and move, once the flocks have been computed.
pub(crate) fn flock_step(
    scenario: &Scenario,
    state: &mut State,
    flocks: &Flocks,
    is_shared: bool,
) -> Moved {
    let tick = state.tick;
    let some = |(first, points): Points| flock_step_some(scenario, tick, flocks, (first, points));
    if !is_shared {
        let points = (
            (&state.ids[..], &state.noises[..]),
            (&mut state.discs[..], &mut state.orientations[..]),
            (&mut state.body_states[..], &mut state.agents[..]),
        );
        return some((0, points));
    }
    let known = state.ids.par_chunks(PER_TASK);
    let known = known.zip(state.noises.par_chunks(PER_TASK));
    let places = state.discs.par_chunks_mut(PER_TASK);
    let places = places.zip(state.orientations.par_chunks_mut(PER_TASK));
    let rest = state.body_states.par_chunks_mut(PER_TASK);
    let rest = rest.zip(state.agents.par_chunks_mut(PER_TASK));
    let tasks = (known, places, rest).into_par_iter().enumerate();
    // A maximum and a sum of integers: the order of the tasks does not matter.
    tasks
        .map(|(task, points)| some((task * PER_TASK, points)))
        .reduce(Moved::default, Moved::and)
}

fn flock_step_some(
    scenario: &Scenario,
    tick: u64,
    flocks: &Flocks,
    (first, points): Points,
) -> Moved {
    let ((ids, noises), (discs, orientations), (body_states, agents)) = points;
    let mut moved = Moved::default();
    let mut turn_rates = [0.0; AT_ONCE];
    let bodies = discs
        .iter_mut()
        .zip(orientations)
        .zip(body_states.iter_mut().zip(agents));
    for (place, (((disc, course), (body_state, agent)), (id, noise))) in
        bodies.zip(ids.iter().zip(noises)).enumerate()
    {
        if place % AT_ONCE == 0 {
            flocks.turn_rates_from(first + place, &mut turn_rates);
        }
        let kind = scenario.kind_of(*id);
        if body_state.status != Status::Active {
            agent.setpoint = Motion::default();
        } else if let Some(flocking) = kind.flocking.as_ref().filter(|_| !body_state.is_external())
        {
            let turn_rate = turn_rates[place % AT_ONCE];
            agent.setpoint = flocking.setpoint(agent, turn_rate, course, (*noise, tick));
        }
        let plan = planned(
            scenario,
            tick,
            &Body {
                kind,
                state: body_state,
                disc,
                course,
                agent,
                may_touch: false,
            },
        );
        moved.add(body_state.go(&plan, kind, scenario.step_s, tick));
        plan.carry_out(scenario, kind, disc, course);
    }
    moved
}
