//! Parsed conditions, and how they are evaluated and printed.

use crate::document::written;
use std::cmp::Ordering;
use std::fmt;

/// A condition on the outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// What is compared.
    pub quantity: Quantity,
    /// The place of its value among the values of an outcome.
    pub place: usize,
    /// How it is compared.
    pub operator: Operator,
    /// What it is compared with; finite.
    pub number: f64,
}

/// What a condition compares with its number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Quantity {
    /// The column of this name.
    Column(String),
    /// The time at which a count reached a number.
    TimeUntil {
        /// The name of the count.
        count: String,
        /// At least 1.
        number: usize,
    },
}

/// How a condition compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// `<=`
    AtMost,
    /// `>=`
    AtLeast,
    /// `<`
    Below,
    /// `>`
    Above,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
}

impl Condition {
    /// Whether it holds for the values of an outcome. It never holds for NaN, not even `!=`: a quarantined run
    /// satisfies nothing.
    #[must_use]
    pub fn holds(&self, values: &[f64]) -> bool {
        let value = values.get(self.place);
        value.is_some_and(|value| self.holds_for(*value))
    }

    /// Whether it holds only for values below the first or above the second of two ends.
    #[must_use]
    pub fn needs_beyond(&self, (low, high): (f64, f64)) -> bool {
        match self.operator {
            Operator::AtLeast => self.number > high,
            Operator::Above => self.number >= high,
            Operator::AtMost => self.number < low,
            Operator::Below => self.number <= low,
            Operator::Equal => self.number > high || self.number < low,
            Operator::NotEqual => false,
        }
    }

    /// Whether it holds for a value of its quantity.
    #[must_use]
    pub fn holds_for(&self, value: f64) -> bool {
        let order = value.partial_cmp(&self.number);
        order.is_some_and(|order| self.operator.accepts(order))
    }
}

impl Operator {
    /// All operators, as they are written.
    pub const ALL: [(&'static str, Self); 6] = [
        ("<=", Self::AtMost),
        (">=", Self::AtLeast),
        ("<", Self::Below),
        (">", Self::Above),
        ("==", Self::Equal),
        ("!=", Self::NotEqual),
    ];

    fn accepts(self, order: Ordering) -> bool {
        match self {
            Self::AtMost => order.is_le(),
            Self::AtLeast => order.is_ge(),
            Self::Below => order.is_lt(),
            Self::Above => order.is_gt(),
            Self::Equal => order.is_eq(),
            Self::NotEqual => order.is_ne(),
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = written(self.number);
        write!(f, "{} {} {number}", self.quantity, self.operator)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Column(name) => f.write_str(name),
            Self::TimeUntil { count, number } => write!(f, "time_until({count} >= {number})"),
        }
    }
}

impl fmt::Display for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = Self::ALL.iter();
        let written = all.find(|(_, operator)| operator == self);
        f.write_str(written.map_or("", |(written, _)| written))
    }
}
