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

/// Most runs in one request, of all its configurations together, so that they fit in memory.
const MOST_ROWS: usize = 1 << 20;

/// Runs to ask for when `missing` are missing of each of some configurations.
fn runs_to_ask(missing: u64, configurations: usize) -> usize {
    let most = (MOST_ROWS / configurations).max(1);
    usize::try_from(missing).unwrap_or(most).min(most)
}
