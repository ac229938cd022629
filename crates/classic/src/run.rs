//! A run of a scenario that is stepped paint by paint and can be changed while it runs.

use crate::runner::Configuration;
use crate::search::{Outcome, Search};
use crate::start::random_team;
use crate::world::ITEMS;
use std::sync::OnceLock;

/// A run of a configuration, in the plain form.
#[derive(Debug, Clone)]
pub struct Run {
    configuration: Configuration,
    seed: u64,
    number: u64,
    search: Search,
    /// Cache of [`Run::outcome`].
    outcome: OnceLock<Outcome>,
}

impl Run {
    /// The run of this seed and number, before its first paint.
    #[must_use]
    pub fn new(configuration: Configuration, seed: u64, number: u64) -> Self {
        let starts = random_team(configuration.robots, seed, number);
        Self {
            configuration,
            seed,
            number,
            search: Search::new(&starts, configuration.task),
            outcome: OnceLock::new(),
        }
    }

    /// Its configuration.
    #[must_use]
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The robots and their finds.
    #[must_use]
    pub fn search(&self) -> &Search {
        &self.search
    }

    /// Number of paints so far.
    #[must_use]
    pub fn paint(&self) -> u64 {
        self.search.simulation().paint()
    }

    /// Advances by one paint. A run that is over does not change.
    pub fn step(&mut self) {
        if !self.search.is_over() {
            self.search.step();
            self.outcome = OnceLock::new();
        }
    }

    /// Continues with another configuration. The robots with the highest indices leave, or new ones enter
    /// at the starts that they have in this run.
    pub fn change(&mut self, to: Configuration) {
        let starts = random_team(to.robots, self.seed, self.number);
        self.search.change(to.task, &starts);
        self.configuration = to;
        self.outcome = OnceLock::new();
    }

    /// The outcome so far, in the order of the columns of [`Configuration`]; after the run is over, the
    /// outcome that a study stores.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.configuration.values(self.outcome())
    }

    fn outcome(&self) -> Outcome {
        *self.outcome.get_or_init(|| {
            if self.search.is_over() {
                self.search.concluded()
            } else {
                self.search.outcome()
            }
        })
    }

    /// Converts paints to seconds.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "paints below 2^53")]
    pub fn seconds(&self, paints: u64) -> f64 {
        paints as f64 / self.configuration.clock.paints_per_s
    }

    /// The time at which each item was found, in seconds; `None` if it has not been found.
    #[must_use]
    pub fn found_s(&self) -> [Option<f64>; ITEMS.len()] {
        let found_at = self.search.found_at();
        found_at.map(|paint| paint.map(|paint| self.seconds(paint)))
    }
}
