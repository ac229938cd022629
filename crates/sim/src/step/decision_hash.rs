//! A hash of the decisions of a run: of each percept, and of the command that it led to.
//!
//! Each thread hashes the decisions of its robots one by one. The chain over these is computed
//! afterwards, in the order of the robots, so that it does not depend on the number of threads.

use crate::run::state::State;
use crate::scenario::Scenario;
use base::hash::Hash;
use base::hashed::Hashed;
use brain::{Command, Motion, Percept};

/// The hash of the decision of a robot; without a percept if none led to it.
#[inline(never)]
pub(super) fn decision_hash(robot: usize, percept: Option<&Percept>, command: &Command) -> u64 {
    let mut hash = Hash::new();
    robot.add_to(&mut hash);
    percept.is_some().add_to(&mut hash);
    if let Some(percept) = percept {
        percept.add_to(&mut hash);
    }
    command.add_to(&mut hash);
    hash.value()
}

/// The hash of a motion that was decided without a percept.
pub(super) fn motion_hash(robot: usize, motion: Motion) -> u64 {
    let command = Command {
        motion,
        ..Command::default()
    };
    decision_hash(robot, None, &command)
}

/// Adds the hashes of the decisions of a step, in the order of the robots.
pub(super) fn add_decisions<'a>(state: &mut State, hashes: impl Iterator<Item = &'a u64>) {
    if let Some(before) = state.decisions {
        state.decisions = Some(chained(before, hashes.copied()));
    }
}

/// Adds the setpoints of all robots that only flock, after a step of a world of such robots; that of
/// a robot that cannot move is 0.
pub(super) fn add_setpoints(scenario: &Scenario, state: &mut State) {
    if let Some(before) = state.decisions {
        let flocks = |robot: &usize| {
            let kind = scenario.kind_of(state.ids[*robot]);
            kind.flocking.is_some() && !state.body_states[*robot].is_external()
        };
        let robots = (0..state.robots()).filter(flocks);
        let hashes = robots.map(|robot| motion_hash(robot, state.agents[robot].setpoint));
        state.decisions = Some(chained(before, hashes));
    }
}

fn chained(before: u64, hashes: impl Iterator<Item = u64>) -> u64 {
    let mut hash = Hash::new();
    hash.add(before);
    hashes.for_each(|decision| hash.add(decision));
    hash.value()
}
