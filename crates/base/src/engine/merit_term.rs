//! What figures of merit are made of.

use std::borrow::Cow;

/// A term that a figure of merit can weigh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeritTerm {
    /// Its name in scenarios, such as `time`.
    pub name: Cow<'static, str>,
    /// The outcome column that it reads.
    pub column: Cow<'static, str>,
    /// For a column without a natural bound, whose terms need a `max`: the `max` that error messages
    /// propose.
    pub usual_max: Option<f64>,
}

impl MeritTerm {
    /// A term on `column`, which has natural bounds.
    #[must_use]
    pub fn new(name: impl Into<Cow<'static, str>>, column: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            column: column.into(),
            usual_max: None,
        }
    }
}

/// A predefined figure of merit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMerit {
    /// Its name in scenarios.
    pub name: &'static str,
    /// Terms and their weights.
    pub weights: &'static [(&'static str, f64)],
}

impl NamedMerit {
    /// Equation 5.2 of Williams 2003: -(0.3 T/10 + 0.2 n + 0.5 failures in ten).
    pub const EQUATION_5_2: Self = Self {
        name: "equation-5.2",
        weights: &[("time", -0.03), ("robots", -0.2), ("failed", -5.0)],
    };
}
