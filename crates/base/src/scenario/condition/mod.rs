//! Conditions on the outcome of a run: `found_parcel >= 9`, `time_until(found_parcel >= 9) <= 1200`.
//!
//! A condition compares a quantity with a number by `<=`, `>=`, `<`, `>`, `==` or `!=`. The quantity is an outcome
//! column, or the time at which a count reached a number. A list of conditions holds if all of them hold.

mod columns;
mod comparison;
mod cursor;
mod parse;

pub use columns::{ConditionColumns, TimesUntil, Unseen};
pub use comparison::{Condition, Operator, Quantity};
pub use cursor::ConditionError;
pub use parse::parse;

#[cfg(test)]
mod tests;
