//! What a procedure has to decide.

/// The range of the merit of every run of a configuration, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The worst merit.
    pub min: f64,
    /// The best merit; not below `min`.
    pub max: f64,
}

/// A choice among configurations by their mean merits; higher is better.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Of each configuration, at least one.
    pub bounds: Vec<Bounds>,
    /// The indifference zone: the smallest difference of mean merits that matters, above 0.
    pub delta: f64,
    /// The probability of a correct selection: above 0, below 1.
    pub confidence: f64,
}

impl Problem {
    /// How many configurations there are.
    #[must_use]
    pub fn configurations(&self) -> usize {
        self.bounds.len()
    }

    /// The evidence at which a claim about one configuration holds against all its rivals together:
    /// the number of rivals divided by the allowed probability of error.
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
