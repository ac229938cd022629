//! Time that threads had a processor: on a shared machine a wall clock says little.

use cpu_time::ProcessTime;
use std::time::Instant;

/// Does some work, and says for how long the threads of this process ran together, in seconds.
pub(crate) fn took(work: impl FnOnce()) -> f64 {
    let start = ProcessTime::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The same, and beside it what a clock on the wall says.
///
/// Of several threads the first leaves out when one waited for another, the second counts also what
/// others did on the machine: the truth lies between.
pub(crate) fn took_by_both(work: impl FnOnce()) -> [f64; 2] {
    let start = Instant::now();
    let processors_s = took(work);
    [processors_s, start.elapsed().as_secs_f64()]
}

/// The middle of some numbers.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
