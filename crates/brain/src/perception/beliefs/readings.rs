//! Sensor readings that are new in a step.

use crate::io::percept::Reading;

/// Older readings are ignored.
pub(super) const MAX_AGE_S: f64 = 5.0;

/// A reading that was not used before: a repeated one is older by the elapsed time.
pub(crate) fn fresh<T: Copy>(
    reading: Option<Reading<T>>,
    last_age_s: &mut Option<f64>,
    elapsed_s: f64,
) -> Option<Reading<T>> {
    let reading = reading.filter(|reading| (0.0..=MAX_AGE_S).contains(&reading.age_s));
    let before_s = core::mem::replace(last_age_s, reading.map(|reading| reading.age_s));
    let is_new = |age_s: f64| before_s.is_none_or(|before_s| age_s < before_s + 0.999 * elapsed_s);
    reading.filter(|reading| is_new(reading.age_s))
}
