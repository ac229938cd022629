//! The classical procedures. They are here to be measured against, not to answer studies: both
//! Rinott's and Kim and Nelson's hold for normal merits only, and miss their guarantee badly on
//! rare failures.
//!
//! * [`Equal`]: the same number of runs for everyone, as in the thesis;
//! * [`Rinott`]: two stages;
//! * [`KimNelson`]: fully sequential.

mod equal;
mod kim_nelson;
mod rinott;
mod tally;

pub use equal::Equal;
pub use kim_nelson::KimNelson;
pub use rinott::{Rinott, rinott_h};

/// Most runs of a configuration in one request, so that a request's merits fit in memory.
const MOST_RUNS_A_REQUEST: u64 = 1000;

/// Runs to ask for when `missing` are missing.
fn runs_to_ask(missing: u64) -> usize {
    usize::try_from(missing.min(MOST_RUNS_A_REQUEST)).unwrap_or(usize::MAX)
}
