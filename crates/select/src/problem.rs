//! What a procedure is asked.

/// Between which two merits every run of a configuration lies, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The worst that a run can come to.
    pub least: f64,
    /// The best; not below `least`.
    pub greatest: f64,
}

/// A choice among configurations, by their mean merits; higher is better.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Of each configuration, at least one.
    pub bounds: Vec<Bounds>,
    /// The difference of mean merits worth finding, above 0.
    pub delta: f64,
    /// How sure the selection must be: above 0, below 1.
    pub confidence: f64,
}

impl Problem {
    /// How many configurations there are.
    #[must_use]
    pub fn configurations(&self) -> usize {
        self.bounds.len()
    }

    /// The evidence at which a claim about one configuration holds against all its rivals together:
    /// the number of rivals divided by the error that is allowed.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "configurations are far fewer than 2^53"
    )]
    pub fn threshold(&self) -> f64 {
        let rivals = self.configurations().saturating_sub(1).max(1);
        rivals as f64 / (1.0 - self.confidence)
    }
}
