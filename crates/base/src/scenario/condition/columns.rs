//! The columns that conditions can refer to.

use std::ops::Range;

/// The columns that a condition can refer to, by the places of their values.
#[derive(Debug, Clone, Copy)]
pub struct ConditionColumns<'n> {
    /// The names of columns, in the order of the values from the first on.
    pub names: &'n [&'n str],
    /// The counts for which there are columns of times.
    pub times: &'n [TimesUntil<'n>],
}

/// The columns with the times at which a count reached 1, 2, 3 and so on; the value is +infinity in a run in which
/// it never did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimesUntil<'n> {
    /// The name of the count.
    pub count: &'n str,
    /// The places of the values, that of 1 first; not empty.
    pub places: Range<usize>,
}
