//! The interim analyses: the numbers of runs after which a procedure evaluates its evidence, 10 and
//! then a tenth more each time.
//!
//! The sequence is the same for every problem, so that the runs of a configuration are always
//! divided into the same blocks: blocks stored by one study serve the next at any confidence.

const FIRST_ANALYSIS_RUNS: usize = 10;

/// The number of runs of a configuration at the first interim analysis after `runs`.
#[must_use]
pub fn next_analysis(runs: usize) -> usize {
    if runs < FIRST_ANALYSIS_RUNS {
        FIRST_ANALYSIS_RUNS
    } else {
        runs + runs.div_ceil(10)
    }
}
