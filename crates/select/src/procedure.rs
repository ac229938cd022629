//! The interface of selection procedures: they request runs and record a number for each.

/// Runs that a procedure needs next: consecutive runs of some configurations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// Which configurations, ascending.
    pub configurations: Vec<usize>,
    /// The number of the first run.
    pub first_run: u64,
    /// How many, at least 1.
    pub runs: usize,
}

/// An eliminated configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Elimination {
    /// Which configuration.
    pub configuration: usize,
    /// Of the configurations remaining then, the one with the most evidence against it; `None` if the
    /// evidence is not of a comparison.
    pub by: Option<usize>,
    /// How many runs it had by then.
    pub runs: u64,
}

/// A way to select one of `k` configurations: compute what `next` requests and pass it to
/// `record`, until `next` returns `None`.
pub trait Procedure {
    /// The runs that it needs next; `None` when it has selected.
    fn next(&self) -> Option<Request>;

    /// Records a number for each run that `next` requested, such as its merit: a row per configuration.
    fn record(&mut self, values: &[f64]);

    /// The configuration selected, or leading so far; `None` if there is none.
    fn selected(&self) -> Option<usize>;

    /// Number of recorded runs per configuration.
    fn runs(&self) -> Vec<u64>;

    /// The configurations that can still be selected, ascending.
    fn survivors(&self) -> Vec<usize>;

    /// Configurations that are shown to meet a requirement, ascending.
    fn certified(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Configurations that are shown not to meet a requirement at all, ascending.
    fn below(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Whether its promise holds. There may be further runs that make it more precise.
    fn is_settled(&self) -> bool {
        self.next().is_none()
    }

    /// The eliminated configurations, in the order of their elimination.
    fn eliminations(&self) -> Vec<Elimination>;
}

/// A procedure whose first runs may show that some configurations cannot be run.
pub trait Exclude: Procedure {
    /// Removes configurations before their first `record`: they are neither requested nor selected. Of
    /// those that are compared, at least one must remain.
    fn exclude(&mut self, configurations: &[usize]);
}
