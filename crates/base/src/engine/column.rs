//! What a study knows of a column of outcomes.

use std::borrow::Cow;

/// What the values of a column are, so that they can be stored compactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Whole numbers.
    Whole,
    /// Any numbers.
    Real,
    /// 0 or 1.
    Flag,
}

/// The smallest and the largest possible value of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest possible value; `None` without a natural bound.
    pub min: Option<f64>,
    /// Largest possible value; `None` without a natural bound, and then a run may return +infinity.
    pub max: Option<f64>,
}

impl Bounds {
    /// Any value that is not negative.
    pub const NOT_NEGATIVE: Self = Self {
        min: Some(0.0),
        max: None,
    };

    /// From 0 to `max`.
    #[must_use]
    pub fn up_to(max: f64) -> Self {
        Self {
            min: Some(0.0),
            max: Some(max),
        }
    }

    /// One value only.
    #[must_use]
    pub fn fixed(value: f64) -> Self {
        Self {
            min: Some(value),
            max: Some(value),
        }
    }
}

/// One number that every run of a configuration returns.
///
/// The bounds follow from the configuration and hold for each run that is not quarantined.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name, with the unit.
    pub name: Cow<'static, str>,
    /// What its values are.
    pub kind: ColumnKind,
    /// Its smallest and largest possible value.
    pub bounds: Bounds,
}
