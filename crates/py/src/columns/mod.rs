//! Values in columns: the array interface of brains, derived from the schemas of percepts and commands.
//!
//! ```text
//! schema         column
//! number         array of floats; NaN without a value
//! integer        array of integers; -1 without a value
//! boolean        array of booleans; false without a value
//! enumeration    array of integers: the number of the value in the schema
//! [T; N]         array of shape (entries, N)
//! object         dict of columns
//! list           dict of the columns of its items, of all entries one after the other, and `row`: the entry of each
//! one of several none
//! ```
//!
//! * [`shape`]: what follows from a schema; [`column`]: columns that are filled, and their arrays;
//! * [`writer`]: values to columns; [`given`]: the columns of a function, checked; [`cell`]: columns to values.

mod cell;
mod column;
mod given;
mod shape;
mod writer;

pub(crate) use given::Given;
pub(crate) use shape::Shape;
pub(crate) use writer::write;
