//! Classical procedures, for comparison. Both hold for normal merits only, and miss their guarantee
//! by far if failures are rare.
//!
//! * [`Rinott`]: two stages;
//! * [`KimNelson`]: fully sequential.

mod kim_nelson;
mod normal;
mod rinott;
mod tally;

pub(crate) use kim_nelson::KimNelson;
pub(crate) use rinott::{Rinott, rinott_h};
