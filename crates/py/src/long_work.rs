//! Work that takes long: on threads, without the interpreter, and open to Ctrl-C.

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::ops::Range;

/// Numbers computed between two looks for Ctrl-C: some hundredths of a second for most teams.
const NUMBERS_PER_BLOCK: u64 = 8192;

/// `block` of consecutive parts of `numbers`, one after the other, joined.
///
/// Between two parts Python's signals are handled; while one is computed other Python threads run.
pub(crate) fn in_blocks<T: Send>(
    py: Python<'_>,
    numbers: Range<u64>,
    threads: Option<usize>,
    block: impl Fn(Range<u64>) -> Vec<T> + Sync,
) -> PyResult<Vec<T>> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build();
    let pool = pool.map_err(|error| PyOSError::new_err(error.to_string()))?;
    let mut results = Vec::new();
    let mut first = numbers.start;
    while first < numbers.end {
        let part = first..numbers.end.min(first.saturating_add(NUMBERS_PER_BLOCK));
        first = part.end;
        results.extend(py.detach(|| pool.install(|| block(part))));
        py.check_signals()?;
    }
    Ok(results)
}
