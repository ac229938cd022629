//! Processor time of threads: on a shared machine, wall-clock time is unreliable.

use cpu_time::ProcessTime;
use std::time::Instant;

/// Does some work and returns the total processor time of all threads of this process, in seconds.
pub(crate) fn took(work: impl FnOnce()) -> f64 {
    let start = ProcessTime::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The same, together with the wall-clock time.
///
/// With several threads, processor time ignores waiting, and wall-clock time includes the load of other
/// processes: the true time is between the two.
pub(crate) fn took_by_both(work: impl FnOnce()) -> [f64; 2] {
    let start = Instant::now();
    let processors_s = took(work);
    [processors_s, start.elapsed().as_secs_f64()]
}

/// The median.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
