//! Exact bounds of an observed share.

/// Clopper and Pearson's one-sided lower bound of a share of which `hits` of `trials` were observed;
/// it is above the truth with a probability of at most `alpha`.
pub(crate) fn lower_bound(hits: u32, trials: u32, alpha: f64) -> f64 {
    if hits == 0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let share = f64::midpoint(low, high);
        if at_least(hits, trials, share) < alpha {
            low = share;
        } else {
            high = share;
        }
    }
    low
}

/// Probability of at least `hits` hits in `trials` when each has a probability of `share`.
fn at_least(hits: u32, trials: u32, share: f64) -> f64 {
    let (hit, miss) = (libm::log(share), libm::log1p(-share));
    let log_factorial = |count: u32| libm::lgamma(f64::from(count) + 1.0);
    let all = log_factorial(trials);
    let exactly = |hits: u32| {
        let ways = all - log_factorial(hits) - log_factorial(trials - hits);
        libm::exp(ways + f64::from(hits) * hit + f64::from(trials - hits) * miss)
    };
    (hits..=trials).map(exactly).sum()
}

#[test]
fn bounds_are_the_closed_forms_at_the_ends() {
    // All of n: alpha^(1/n). One of two: 1 - (1 - share)^2 = alpha.
    assert!((lower_bound(90, 90, 0.01) - libm::pow(0.01, 1.0 / 90.0)).abs() < 1e-9);
    assert!((lower_bound(1, 2, 0.19) - 0.1).abs() < 1e-9);
    assert!(lower_bound(0, 5, 0.01).abs() < f64::EPSILON);
    // The published 99% interval of 19,396 of 20,000 (two-sided, 0.005 each).
    assert!((lower_bound(19_396, 20_000, 0.005) - 0.9665).abs() < 1e-4);
}
