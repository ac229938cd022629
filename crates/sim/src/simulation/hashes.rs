//! Hashes of a run: of its state, and of its decisions.

use super::Simulation;
use base::hash::Hash;

impl Simulation {
    /// A hash of the state ([`State::hash`](super::State::hash)) and of the world with its obstacles
    /// and terrain, if it has any.
    #[must_use]
    pub fn hash(&self) -> u64 {
        let state = self.state.hash();
        self.scenario.world_hash.map_or(state, |world| {
            let mut hash = Hash::new();
            hash.add(state);
            hash.add(world);
            hash.value()
        })
    }

    /// Hashes all decisions from now on, beginning with a value: each step of each brain adds its
    /// percept and its command. Commands that replace decisions are covered, and so are the percepts
    /// and commands of external bodies, except for percepts that are ignored. Nothing in the run
    /// changes. See [`State::decision_hash`](super::State::decision_hash).
    pub fn hash_decisions(&mut self, from: u64) {
        self.state.decisions = Some(from);
    }
}
