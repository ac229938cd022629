//! Which configuration is best, with a stated guarantee: pure functions on numbers.
//!
//! * [`procedure`]: what every procedure has in common;
//! * [`mod@reference`]: the classical procedures, to be measured against.

mod normal;
pub mod procedure;
pub mod reference;
