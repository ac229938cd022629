//! What every selection procedure has in common: it asks for runs, is told merits, and decides.

/// A rectangle of runs: `runs` runs from number `first_run` on, of each of some configurations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// Configurations by number, ascending.
    pub configurations: Vec<usize>,
    /// Number of the first run.
    pub first_run: u64,
    /// How many runs of each configuration.
    pub runs: usize,
}

/// A configuration that is out of the race.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elimination {
    /// Which one.
    pub configuration: usize,
    /// The one that was shown to be better.
    pub by: usize,
    /// After how many runs of it.
    pub runs: u64,
}

/// A selection procedure. Merits: higher is better.
pub trait Procedure {
    /// What it needs to know next; `None` when it has decided.
    fn next(&self) -> Option<Request>;
    /// The merits of the request, row-major `(configurations, runs)`.
    fn tell(&mut self, merits: &[f64]);
    /// The best configuration as far as is known.
    fn best(&self) -> usize;
    /// Runs told so far of each configuration.
    fn runs(&self) -> &[u64];
    /// Configurations that are out, in order.
    fn eliminations(&self) -> &[Elimination];
}
