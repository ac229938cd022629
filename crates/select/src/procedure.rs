//! How a procedure asks for runs and hears of them.

/// Runs that a procedure wants next: a rectangle of configurations and consecutive runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// Which configurations, ascending.
    pub configurations: Vec<usize>,
    /// The first run's number.
    pub first_run: u64,
    /// How many, at least 1.
    pub runs: usize,
}

/// A configuration that is out, and who put it out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Elimination {
    /// Which configuration.
    pub configuration: usize,
    /// Of those then still in, the one with the most evidence against it.
    pub by: usize,
    /// How many runs it had by then.
    pub runs: u64,
}

/// A way to select the best of `k` configurations: ask it with `next`, tell it what came out, until
/// it asks for nothing more.
pub trait Procedure {
    /// What it wants next; `None` when it has selected.
    fn next(&self) -> Option<Request>;

    /// Tells the merits of what `next` asked for, a row a configuration.
    fn tell(&mut self, merits: &[f64]);

    /// The configuration selected, or leading so far.
    fn best(&self) -> usize;

    /// Runs of each configuration so far.
    fn runs(&self) -> Vec<u64>;

    /// The configurations that can still be selected, ascending.
    fn survivors(&self) -> Vec<usize>;

    /// Those that are out, in the order in which they went.
    fn eliminations(&self) -> Vec<Elimination>;
}
