//! Which configuration is best, with a stated guarantee: pure functions on numbers, no input or
//! output, the same bytes on every machine.
//!
//! | to know | read |
//! |---|---|
//! | how a procedure asks for runs and hears of them | [`procedure`] |
//! | the evidence that one configuration gathers against another | `duel` |
//! | the default: the best, if it is better than every other by delta | [`race`] |
//! | the strict one: within delta of the best, whatever the truth | [`strict`] |
//! | bounds of a mean that hold at every moment | [`bounds`] |
//! | the classical procedures, to be measured against | [`mod@reference`] |

pub mod bounds;
mod duel;
mod normal;
pub mod problem;
pub mod procedure;
pub mod race;
pub mod reference;
mod samples;
pub mod schedule;
pub mod strict;

pub use problem::{Bounds, Problem};
pub use procedure::{Elimination, Procedure, Request};
pub use race::Race;
pub use strict::Strict;
