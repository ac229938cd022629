//! The columns that conditions can refer to.

use std::ops::Range;

/// The columns that a condition can refer to, by the places of their values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConditionColumns {
    /// The names of columns, in the order of the values from the first on.
    pub names: Vec<String>,
    /// The counts for which there are columns of times.
    pub times: Vec<TimesUntil>,
}

/// The columns with the times at which a count reached 1, 2, 3 and so on; the value is +infinity in a run in which
/// it never did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimesUntil {
    /// The name of the count.
    pub count: String,
    /// The places of the values, that of 1 first; not empty.
    pub places: Range<usize>,
}
