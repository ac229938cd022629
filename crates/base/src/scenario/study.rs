//! Settings of a study.

use super::factors::{Factor, factors};
use super::values::Values;
use crate::document::{Section, Value};
use crate::engine::Engine;
use std::fmt;

const MAX_POINTS: u32 = 100_000;

/// Default probability that the answer of a study is right.
pub(super) const CONFIDENCE: f64 = 0.95;

/// What a study with a requirement minimises by default: the number of robots.
pub(super) const MINIMIZE: &str = "robots";

/// Settings of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The factors; empty to run a single configuration.
    pub factors: Vec<Factor>,
    /// The configurations to compare.
    pub design: Design,
    /// Indifference zone: the smallest difference in merit that matters; above 0.
    pub delta: Option<f64>,
    /// Probability that the answer is right; above 0.5 and below 1.
    pub confidence: f64,
    /// What a study with a requirement minimises, as an expression.
    pub minimize: String,
    /// Which configurations it compares, as an expression; `None` for all.
    pub filter: Option<String>,
}

/// The configurations to compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// All combinations of values.
    Factorial,
    /// A Latin hypercube of this number of points.
    LatinHypercube(u32),
    /// This number of points of a Sobol' sequence; a power of two.
    Sobol(u32),
}

impl Design {
    fn parse(text: &str) -> Option<Self> {
        if text == "factorial" {
            return Some(Self::Factorial);
        }
        let (name, points) = text.split_once(':')?;
        let points: u32 = points.parse().ok()?;
        let points = Some(points).filter(|points| (1..=MAX_POINTS).contains(points))?;
        match name {
            "lhs" => Some(Self::LatinHypercube(points)),
            "sobol" => points.is_power_of_two().then_some(Self::Sobol(points)),
            _ => None,
        }
    }
}

impl fmt::Display for Design {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Factorial => f.write_str("factorial"),
            Self::LatinHypercube(points) => write!(f, "lhs:{points}"),
            Self::Sobol(points) => write!(f, "sobol:{points}"),
        }
    }
}

pub(super) fn study(section: &Section, engine: &dyn Engine) -> Option<Study> {
    section.only(&["vary", "delta", "confidence", "design", "minimize", "where"]);
    let vary = section.section("vary");
    let factors = factors(&vary, engine);
    let design = if_given(section, "design", || {
        let allowed = format!(
            "\"factorial\", or \"lhs:200\" or \"sobol:256\" with 1 to {MAX_POINTS} points (a power of \
             two for sobol)"
        );
        section.parsed("design", &allowed, Design::parse)
    });
    let delta = if_given(section, "delta", || {
        section.number_if("delta", "a number above 0", |delta| delta > 0.0)
    });
    let confidence = if_given(section, "confidence", || confidence(section));
    let minimize = if_given(section, "minimize", || section.line("minimize"));
    let filter = if_given(section, "where", || section.line("where"));
    let design = design.map(|design| design.unwrap_or(Design::Factorial));
    let is_listed = check_ranges(&vary, factors.as_deref()?, design?);
    is_listed.then_some(Study {
        factors: factors?,
        design: design?,
        delta: delta?,
        confidence: confidence?.unwrap_or(CONFIDENCE),
        minimize: minimize?.unwrap_or_else(|| MINIMIZE.to_owned()),
        filter: filter?,
    })
}

/// The confidence; the error for a percentage suggests the same as a share.
fn confidence(section: &Section) -> Option<f64> {
    let given = match section.value("confidence") {
        Some(Value::Integer(number)) => i32::try_from(*number).ok().map(f64::from),
        Some(Value::Float(number)) => Some(*number),
        _ => None,
    };
    let is_allowed = |share: &f64| *share > 0.5 && *share < 1.0;
    let share = given.filter(is_allowed);
    if share.is_none() {
        // Rounded: 99.9 / 100 is not 0.999.
        let meant = given.map(|percent| (percent * 1e10).round() / 1e12);
        let suggestion = meant.filter(is_allowed).map(|share| share.to_string());
        let allowed = "a number above 0.5 and below 1, such as 0.95";
        section.error_for("confidence", allowed, suggestion);
    }
    share
}

/// `None` for an error, `Some(None)` for a key that is missing.
#[expect(clippy::option_option, reason = "an error, a missing key, and a value")]
fn if_given<T>(section: &Section, key: &str, read: impl Fn() -> Option<T>) -> Option<Option<T>> {
    if section.has(key) {
        read().map(Some)
    } else {
        Some(None)
    }
}

/// Only a space-filling design can choose from all numbers of a range.
fn check_ranges(vary: &Section, factors: &[Factor], design: Design) -> bool {
    let is_range = |factor: &&Factor| matches!(factor.values, Values::Between(..));
    let mut ranges = factors.iter().filter(is_range).peekable();
    if design != Design::Factorial || ranges.peek().is_none() {
        return true;
    }
    for factor in ranges {
        let allowed = "a list of values with the design \"factorial\"; a range of numbers needs a \
                       space-filling design, such as design = \"lhs:200\" or \"sobol:256\"";
        vary.error(&factor.path, allowed);
    }
    false
}
