//! Whether bounds of means are valid at every moment.

use crate::cases::Case;
use crate::random::Place;
use crate::selection::Outcome;
use select::Bounds;
use select::bounds::mean_exceeds;
use select::interim_analyses::next_analysis;

/// Number of first runs after each of which the bounds are checked; later as the procedures do.
const CHECKED_SINGLY: usize = 30;

/// Checks the bounds of all means together over `runs` runs per configuration. Correct: none
/// was ever wrong, though each may be with its share of `alpha`.
pub(crate) fn check(case: &dyn Case, runs: usize, alpha: f64, start: Place) -> Outcome {
    let (means, bounds) = (case.means(), case.bounds());
    let share = alpha / f64::from(2 * u32::try_from(means.len()).unwrap_or(u32::MAX));
    let holds = |configuration: usize| {
        let merit = |run| case.sample(Place { run, ..start }, configuration);
        let merits: Vec<f64> = (0..runs as u64).map(merit).collect();
        let (mean, bounds) = (means[configuration], bounds[configuration]);
        hold(&merits, bounds, mean, share)
            && hold(&negated(&merits), mirrored(bounds), -mean, share)
    };
    Outcome {
        correct: (0..means.len()).all(holds),
        runs: (runs * means.len()) as u64,
    }
}

/// Whether the lower bound never was above the mean.
fn hold(merits: &[f64], bounds: Bounds, mean: f64, alpha: f64) -> bool {
    let after = |runs: &usize| {
        Some(if *runs < CHECKED_SINGLY {
            runs + 1
        } else {
            next_analysis(*runs)
        })
    };
    std::iter::successors(Some(1), after)
        .take_while(|runs| *runs <= merits.len())
        .all(|runs| !mean_exceeds(&merits[..runs], bounds, mean, alpha))
}

fn negated(merits: &[f64]) -> Vec<f64> {
    merits.iter().map(|merit| -merit).collect()
}

fn mirrored(bounds: Bounds) -> Bounds {
    Bounds {
        min: -bounds.max,
        max: -bounds.min,
    }
}
