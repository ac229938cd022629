//! The columns that conditions can refer to.

use std::ops::Range;

/// The columns that a condition can refer to, by the places of their values.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ConditionColumns {
    /// The names of columns, in the order of the values from the first on.
    pub names: Vec<String>,
    /// The counts for which there are columns of times.
    pub times: Vec<TimesUntil>,
    /// What a run cannot show, because it ends before.
    pub unseen: Vec<Unseen>,
}

/// The values of a column that no run shows, because it ends before: what would have come then is unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The place of the column's value.
    pub place: usize,
    /// The smallest and the largest value that a run shows for certain.
    pub seen: (f64, f64),
    /// When a run ends, such as "found >= 3".
    pub end: String,
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
