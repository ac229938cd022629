//! One run of a scenario, stepped by hand and changed on the way: paint by paint what studies run.

use crate::runner::Configuration;
use crate::search::Search;
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
    /// What it comes to, once that has been asked for.
    values: OnceLock<[f64; 6]>,
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
            values: OnceLock::new(),
        }
    }

    /// What it depends on.
    #[must_use]
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The robots, what they have found, and whether that is all.
    #[must_use]
    pub fn search(&self) -> &Search {
        &self.search
    }

    /// Paints so far.
    #[must_use]
    pub fn paint(&self) -> u64 {
        self.search.simulation().paint()
    }

    /// One paint; a run that is over stays as it is.
    pub fn step(&mut self) {
        if !self.search.is_over() {
            self.search.step();
            self.values = OnceLock::new();
        }
    }

    /// Goes on with another configuration. The robots with the highest numbers leave, or more come
    /// in where they would have started in this run.
    pub fn change(&mut self, to: Configuration) {
        let starts = random_team(to.robots, self.seed, self.number);
        self.search.change(to.task, &starts);
        self.configuration = to;
        self.values = OnceLock::new();
    }

    /// What it has given so far, in the order of the [`Configuration`]'s columns; once it is over,
    /// what studies are told of it.
    #[must_use]
    pub fn values(&self) -> [f64; 6] {
        *self.values.get_or_init(|| {
            let is_over = self.search.is_over();
            let outcome = if is_over {
                self.search.concluded()
            } else {
                self.search.outcome()
            };
            self.configuration.values(outcome)
        })
    }

    /// Seconds that so many paints are.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "paints below 2^53")]
    pub fn seconds(&self, paints: u64) -> f64 {
        paints as f64 / self.configuration.clock.paints_per_s
    }

    /// When each item was found, in seconds, if it was.
    #[must_use]
    pub fn found_s(&self) -> [Option<f64>; ITEMS.len()] {
        let found_at = self.search.found_at();
        found_at.map(|paint| paint.map(|paint| self.seconds(paint)))
    }
}
