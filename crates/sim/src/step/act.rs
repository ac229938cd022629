//! Act: every body executes the motion setpoint of its brain as far as it can, and stops at
//! obstacles.
//!
//! First each robot plans its path as if it were alone. Then the paths are cut where they meet
//! static geometry and where they meet each other, the earliest encounter first: a robot that stops
//! may no longer be in the way of others, or may now be in it. Last, all move. An encounter stops
//! both bodies, unless they leave what they touched before; bodies do not slide or bounce.

use super::encounters::Encounters;
use super::neighbours::Neighbours;
use super::parallel::ROBOTS_PER_TASK;
use super::plan::{Plan, Stop};
use crate::bodies::body_state::{BodyState, Status};
use crate::bodies::kind::Kind;
use crate::bodies::path::Orientation;
use crate::run::state::State;
use crate::scenario::Scenario;
use base::geometry::Disc;
use brain::AgentId;
use rayon::prelude::*;

/// The plans of all robots, kept between steps so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Moves {
    plans: Vec<Plan>,
    encounters: Encounters,
}

/// The result of all moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Moved {
    /// The farthest that one robot has moved.
    pub(crate) farthest_m: f64,
    pub(crate) collisions: u64,
}

impl Moves {
    /// Room for the plans of all robots.
    pub(crate) fn plans(&mut self, robots: usize) -> &mut [Plan] {
        self.plans.resize(robots, Plan::REST);
        &mut self.plans
    }

    /// Moves all robots according to their plans.
    pub(crate) fn act(
        &mut self,
        scenario: &Scenario,
        state: &mut State,
        neighbours: &Neighbours,
        is_shared: bool,
    ) -> Moved {
        self.encounters
            .collect(&self.plans, &state.discs, neighbours, scenario.contact_m);
        let met = self.encounters.resolve(&mut self.plans, state, neighbours);
        let moved = go(&self.plans, scenario, state, is_shared);
        Moved {
            // Each stops a robot that moves, except for those that begin at the very same time.
            collisions: (moved.collisions + met).min(state.robots() as u64),
            ..moved
        }
    }
}

/// Moves all robots according to their plans.
fn go(plans: &[Plan], scenario: &Scenario, state: &mut State, is_shared: bool) -> Moved {
    let State {
        tick,
        ids,
        discs,
        orientations,
        body_states,
        ..
    } = state;
    let some = |(plans, ids, discs, orientations, body_states): Bodies| {
        let mut moved = Moved::default();
        let bodies = discs.iter_mut().zip(orientations).zip(body_states);
        for ((plan, id), ((disc, course), body_state)) in plans.iter().zip(ids).zip(bodies) {
            let kind = scenario.kind_of(*id);
            moved.add(body_state.go(plan, kind, scenario.step_s, *tick));
            plan.carry_out(scenario, kind, disc, course);
        }
        moved
    };
    if !is_shared {
        return some((plans, ids, discs, orientations, body_states));
    }
    let tasks = (
        plans.par_chunks(ROBOTS_PER_TASK),
        ids.par_chunks(ROBOTS_PER_TASK),
        discs.par_chunks_mut(ROBOTS_PER_TASK),
        orientations.par_chunks_mut(ROBOTS_PER_TASK),
        body_states.par_chunks_mut(ROBOTS_PER_TASK),
    );
    // A maximum and a sum of integers: the order of the tasks does not matter.
    tasks
        .into_par_iter()
        .map(some)
        .reduce(Moved::default, Moved::and)
}

type Bodies<'a> = (
    &'a [Plan],
    &'a [AgentId],
    &'a mut [Disc],
    &'a mut [Orientation],
    &'a mut [BodyState],
);

impl Moved {
    pub(crate) fn add(&mut self, other: Self) {
        self.farthest_m = self.farthest_m.max(other.farthest_m);
        self.collisions += other.collisions;
    }

    pub(crate) fn and(mut self, other: Self) -> Self {
        self.add(other);
        self
    }
}

impl BodyState {
    /// Updates the state of the body after its move.
    #[inline]
    pub(crate) fn go(&mut self, plan: &Plan, kind: &Kind, step_s: f64, tick: u64) -> Moved {
        let gone_m = plan.path.length_m.abs() * plan.path.until;
        let is_stopped = plan.stop > Stop::Pressed;
        self.speed_m_s = if is_stopped {
            0.0
        } else {
            plan.motion.speed_m_s
        };
        self.turn_rate_rad_s = plan.motion.turn_rate_rad_s;
        self.distance_m += gone_m;
        let is_collision = is_stopped && !self.is_touching;
        // Only free motion ends a contact: a robot that turns on the spot is still there.
        self.is_touching = plan.stop != Stop::Nothing || (self.is_touching && gone_m == 0.0);
        let stands_pressed = plan.stop == Stop::Pressed && gone_m == 0.0;
        let stays_pressed = self.is_pressed && tick < self.held_until;
        self.is_pressed = is_stopped || stands_pressed || stays_pressed;
        if is_collision {
            self.collide(kind, tick);
        }
        self.drain(plan, kind, gone_m, step_s);
        Moved {
            farthest_m: gone_m,
            collisions: u64::from(is_collision && plan.stop == Stop::Still),
        }
    }

    pub(super) fn collide(&mut self, kind: &Kind, tick: u64) {
        self.collisions += 1;
        self.held_until = tick + 1 + kind.collision.stop_steps;
        let is_too_often = self.collisions >= kind.collision.max_collisions;
        if is_too_often && self.status == Status::Active && !self.is_external() {
            self.status = Status::Broken;
        }
    }

    /// Takes the energy of a step from the battery.
    #[inline]
    fn drain(&mut self, plan: &Plan, kind: &Kind, gone_m: f64, step_s: f64) {
        let is_drained = self.status == Status::Active && !self.is_external();
        let Some(battery) = kind.battery.filter(|_| is_drained) else {
            return;
        };
        let is_moving = gone_m > 0.0 || plan.motion.turn_rate_rad_s != 0.0;
        let move_w = if is_moving { battery.move_w } else { 0.0 };
        let moving_j = move_w * step_s + battery.move_j_per_m * gone_m;
        let standing_w = battery.idle_w + plan.sensing_w;
        let used_j = self.energy_j;
        self.energy_j += standing_w * step_s + moving_j * plan.effort;
        if self.energy_j >= battery.capacity_j {
            // Energy that was used is never returned.
            self.energy_j = battery.capacity_j.max(used_j);
            self.status = Status::Empty;
        }
    }
}
