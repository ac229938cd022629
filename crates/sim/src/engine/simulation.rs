//! One run, stepped by hand.

use super::outcome::Outcome;
use super::state::{NoRoom, State};
use super::tick::Workshop;
use crate::scenario::Scenario;
use std::sync::Arc;

/// A run, and what it needs to go on.
#[derive(Debug, Clone)]
pub struct Simulation {
    scenario: Arc<Scenario>,
    state: State,
    workshop: Workshop,
}

impl Simulation {
    /// A run at its beginning. Threads share the work of its steps if there are thousands of robots.
    ///
    /// # Errors
    /// If the world has no room for an item or a robot.
    pub fn new(scenario: Arc<Scenario>, seed: u64, run: u64) -> Result<Self, NoRoom> {
        let state = State::new(&scenario, seed, run)?;
        let workshop = Workshop::new(&scenario, true);
        Ok(Self {
            scenario,
            state,
            workshop,
        })
    }

    /// Takes one step, also after the run is over.
    pub fn step(&mut self) {
        self.workshop.tick(&self.scenario, &mut self.state);
    }

    /// Takes steps until the run is over.
    pub fn finish(&mut self) -> Outcome {
        while !self.state.is_over(&self.scenario) {
            self.step();
        }
        self.outcome()
    }

    /// What the run has given so far.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        Outcome::of(&self.scenario, &self.state)
    }

    /// Where the run is.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }
}
