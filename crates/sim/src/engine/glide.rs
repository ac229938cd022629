//! How points go that do nothing but go with the others.
//!
//! None is ever in another's way, so each goes as soon as it has decided: what is known of it is read
//! from memory and written there once.

use super::act::{Body, Moved, planned};
use super::flocks::{AT_ONCE, Flocks, PER_TASK};
use super::mind::Mind;
use super::state::{Hull, State, Status};
use crate::body::path::Course;
use crate::scenario::Scenario;
use base::geometry::Disc;
use base::noise::Noise;
use brain::{Motion, RobotId};
use rayon::prelude::*;

/// Some points that follow each other, from the first on.
type Points<'a> = (
    usize,
    (
        (&'a [RobotId], &'a [Noise]),
        (&'a mut [Disc], &'a mut [Course]),
        (&'a mut [Hull], &'a mut [Mind]),
    ),
);

/// Lets all points decide and go, once the flocks have been asked.
pub(crate) fn glide(
    scenario: &Scenario,
    state: &mut State,
    flocks: &Flocks,
    is_shared: bool,
) -> Moved {
    let tick = state.tick;
    let some = |(first, points): Points| glide_some(scenario, tick, flocks, (first, points));
    if !is_shared {
        let points = (
            (&state.ids[..], &state.noises[..]),
            (&mut state.discs[..], &mut state.courses[..]),
            (&mut state.hulls[..], &mut state.minds[..]),
        );
        return some((0, points));
    }
    let known = state.ids.par_chunks(PER_TASK);
    let known = known.zip(state.noises.par_chunks(PER_TASK));
    let places = state.discs.par_chunks_mut(PER_TASK);
    let places = places.zip(state.courses.par_chunks_mut(PER_TASK));
    let rest = state.hulls.par_chunks_mut(PER_TASK);
    let rest = rest.zip(state.minds.par_chunks_mut(PER_TASK));
    let tasks = (known, places, rest).into_par_iter().enumerate();
    // A greatest number and a sum of whole ones: the order of the tasks does not matter.
    tasks
        .map(|(task, points)| some((task * PER_TASK, points)))
        .reduce(Moved::default, Moved::and)
}

fn glide_some(scenario: &Scenario, tick: u64, flocks: &Flocks, (first, points): Points) -> Moved {
    let ((ids, noises), (discs, courses), (hulls, minds)) = points;
    let mut moved = Moved::default();
    let mut turn_rates = [0.0; AT_ONCE];
    let bodies = discs
        .iter_mut()
        .zip(courses)
        .zip(hulls.iter_mut().zip(minds));
    for (place, (((disc, course), (hull, mind)), (id, noise))) in
        bodies.zip(ids.iter().zip(noises)).enumerate()
    {
        if place % AT_ONCE == 0 {
            flocks.tell(first + place, &mut turn_rates);
        }
        let kind = &scenario.kinds[usize::from(id.kind)];
        if hull.status != Status::Active {
            mind.wanted = Motion::default();
        } else if let Some(flocking) = kind.flocking.as_ref().filter(|_| !hull.is_external) {
            let turn_rate = turn_rates[place % AT_ONCE];
            mind.wanted = flocking.wanted(mind, turn_rate, course, (*noise, tick));
        }
        let plan = planned(
            scenario,
            tick,
            &Body {
                kind,
                hull,
                disc,
                course,
                mind,
                may_touch: false,
            },
        );
        moved.add(hull.go(&plan, kind, scenario.step_s, tick));
        plan.carry_out(scenario, kind, disc, course);
    }
    moved
}
