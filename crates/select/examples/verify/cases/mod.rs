//! Problems whose answer is known.

mod capped;
mod failures;
mod hills;
mod lottery;
mod normal;
mod teams;

pub(crate) use capped::Capped;
pub(crate) use failures::Failures;
pub(crate) use hills::Hills;
pub(crate) use lottery::Lottery;
pub(crate) use normal::Normal;
pub(crate) use teams::Teams;

use crate::random::Place;
use select::Bounds;

/// A problem whose answer is known.
pub(crate) trait Case: Sync {
    /// Mean merit of each configuration.
    fn means(&self) -> Vec<f64>;

    /// The range of the merits of each configuration.
    fn bounds(&self) -> Vec<Bounds>;

    /// The indifference zone.
    fn delta(&self) -> f64;

    /// The merit of one run.
    fn sample(&self, place: Place, configuration: usize) -> f64;
}

/// Whether selecting a configuration is right: it is less than delta worse than the best.
pub(crate) fn right(case: &dyn Case) -> Vec<bool> {
    let means = case.means();
    let best = means.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // A gap of delta itself is wrong, however it was rounded.
    let min = best - case.delta() * (1.0 - 1e-9);
    means.iter().map(|mean| *mean > min).collect()
}
