//! After how many runs a procedure looks: 10, and then a tenth more each time.
//!
//! The sequence is the same for every problem, so that a configuration's runs always come in the
//! same pieces: pieces kept from one study serve the next, whatever its confidence.

const FIRST: usize = 10;

/// How many runs a configuration has at the look that follows `runs`.
#[must_use]
pub fn next_look(runs: usize) -> usize {
    if runs < FIRST {
        FIRST
    } else {
        runs + runs.div_ceil(10)
    }
}
