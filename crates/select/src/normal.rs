//! The normal distribution, the same bytes on every machine.

/// Probability that a standard normal variable is at most `x`.
pub(crate) fn cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}
