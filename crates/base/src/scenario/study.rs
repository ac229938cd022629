//! What a study does.

use super::factors::{Factor, factors};
use super::values::Values;
use crate::document::Section;
use crate::engine::Engine;
use std::fmt;

const MAX_POINTS: u32 = 100_000;

/// How often a study's answer is to be right, if the scenario does not say.
pub(super) const CONFIDENCE: f64 = 0.95;

/// What a study does.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// What is varied; nothing, if one configuration is to be run.
    pub factors: Vec<Factor>,
    /// Which configurations are compared.
    pub design: Design,
    /// A difference of merit that is worth knowing; above 0.
    pub delta: Option<f64>,
    /// How often the answer is to be right; above 0.5 and below 1.
    pub confidence: f64,
}

/// Which configurations are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// Each value of each factor with each of every other.
    Factorial,
    /// So many points of a Latin hypercube.
    LatinHypercube(u32),
    /// So many points of a Sobol' sequence; a power of two.
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
    section.only(&["vary", "delta", "confidence", "design"]);
    let vary = section.section("vary");
    let factors = factors(&vary, engine);
    let design = if_given(section, "design", || {
        let allowed = format!(
            "\"factorial\", \"lhs:200\" or \"sobol:256\", of 1 to {MAX_POINTS} points (for sobol a \
             power of two)"
        );
        section.parsed("design", &allowed, Design::parse)
    });
    let delta = if_given(section, "delta", || {
        section.number_if("delta", "a number above 0", |delta| delta > 0.0)
    });
    let confidence = if_given(section, "confidence", || {
        let allowed = "a number above 0.5 and below 1, such as 0.95";
        section.number_if("confidence", allowed, |share| share > 0.5 && share < 1.0)
    });
    let design = design.map(|design| design.unwrap_or(Design::Factorial));
    let is_listed = tell_ranges_without_points(&vary, factors.as_deref()?, design?);
    is_listed.then_some(Study {
        factors: factors?,
        design: design?,
        delta: delta?,
        confidence: confidence?.unwrap_or(CONFIDENCE),
    })
}

/// `None` for an error, `Some(None)` for a key that is not there.
#[expect(clippy::option_option, reason = "an error, nothing, and a value")]
fn if_given<T>(section: &Section, key: &str, read: impl Fn() -> Option<T>) -> Option<Option<T>> {
    if section.has(key) {
        read().map(Some)
    } else {
        Some(None)
    }
}

/// Only a space-filling design can choose from all the numbers of a range.
fn tell_ranges_without_points(vary: &Section, factors: &[Factor], design: Design) -> bool {
    let is_range = |factor: &&Factor| matches!(factor.values, Values::Between(..));
    let mut ranges = factors.iter().filter(is_range).peekable();
    if design != Design::Factorial || ranges.peek().is_none() {
        return true;
    }
    for factor in ranges {
        let allowed = "a list of values where the design is \"factorial\"; design = \"lhs:200\" or \
                       \"sobol:256\" takes points from a range of any numbers";
        vary.error(&factor.path, allowed);
    }
    false
}
