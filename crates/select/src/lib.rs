//! Which configuration is best, with a stated guarantee: pure functions on numbers, without input or
//! output, with the same bytes on every machine.
//!
//! | topic | module |
//! |---|---|
//! | how a procedure requests runs and records their merits | [`procedure`] |
//! | evidence that one configuration gathers against another | `betting_test` |
//! | the default: the best, if it is better than every other by delta | [`race`] |
//! | the strict one: within delta of the best in every case | [`strict`] |
//! | the cheapest that meets a requirement | [`requirement`] |
//! | evidence that a probability is above a limit | `proportion_test` |
//! | a fixed number of runs per configuration, without a guarantee | [`equal_allocation`] |
//! | bounds of a quantile that are valid at every moment | [`quantiles`] |
//! | bounds of a mean that are valid at every moment | [`bounds`] |

mod betting_test;
pub mod bounds;
pub mod equal_allocation;
pub mod interim_analyses;
pub mod problem;
pub mod procedure;
mod proportion_test;
pub mod quantiles;
pub mod race;
pub mod requirement;
mod samples;
pub mod strict;

pub use equal_allocation::EqualAllocation;
pub use problem::{Bounds, Problem};
pub use procedure::{Elimination, Exclude, Procedure, Request};
pub use race::Race;
pub use requirement::{Requirement, RequirementProblem};
pub use strict::Strict;
