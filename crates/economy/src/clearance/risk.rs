//! The probability that at least one mine is left.

/// The remaining risk of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Risk {
    /// Expected number of mines without a mark.
    pub unmarked: f64,
    /// Expected number of mines at marks.
    pub marked: f64,
    /// Probability that at least one mine is left in the lane.
    pub probability: f64,
}

impl Risk {
    /// The risk of an expected number of mines without a mark and the probabilities of marks.
    pub(super) fn new(unmarked: f64, marks: impl Iterator<Item = f64>) -> Self {
        let (mut marked, mut nats) = (0.0, unmarked);
        for mine in marks {
            marked += mine;
            nats -= libm::log1p(-mine);
        }
        Self {
            unmarked,
            marked,
            probability: chance_of_any(nats),
        }
    }

    /// Expected number of mines that are left.
    #[must_use]
    pub fn expected(&self) -> f64 {
        self.unmarked + self.marked
    }
}

/// Probability that a Poisson number with a mean is not 0.
pub(super) fn chance_of_any(mean: f64) -> f64 {
    -libm::expm1(-mean)
}
