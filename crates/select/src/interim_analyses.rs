//! After how many runs a procedure evaluates its evidence: after 10, then after a tenth more each
//! time.
//!
//! The sequence is the same for every problem, so that the runs of a configuration are always
//! divided into the same blocks: blocks stored by one study serve the next at any confidence.

const FIRST_LOOK: usize = 10;

/// The number of runs of a configuration at the evaluation after `runs`.
#[must_use]
pub fn next_look(runs: usize) -> usize {
    if runs < FIRST_LOOK {
        FIRST_LOOK
    } else {
        runs + runs.div_ceil(10)
    }
}
