//! What a mission must meet, and in which share of missions.

use super::condition::{Condition, ConditionColumns, parse};
use crate::document::{Node, Section, Value};
use crate::error::InputError;

/// Maximum number of conditions.
pub(super) const MAX_CONDITIONS: usize = 20;

/// Default share of missions.
pub(super) const PROBABILITY: f64 = 0.95;

/// Default tolerance, as a part of the share of missions that need not meet the requirement.
const PART_OF_REST: f64 = 0.4;

/// Conditions that must all hold in a share of the missions.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    /// At least one, each with its text.
    pub conditions: Vec<(String, Condition)>,
    /// The share of missions in which all must hold; above 0, below 1.
    pub probability: f64,
    /// A share of at least this much more is never taken for one that is too low; above 0, at most
    /// 1 - `probability`.
    pub tolerance: f64,
}

/// Reads a requirement on these columns.
pub(super) fn requirement(section: &Section, columns: &ConditionColumns) -> Option<Requirement> {
    section.only(&["all", "probability", "tolerance"]);
    let probability = probability(section);
    let rest = 1.0 - probability.unwrap_or(PROBABILITY);
    // Rounded, so that 0.95 has the tolerance 0.02.
    let usual = (PART_OF_REST * rest * 1e12).round() / 1e12;
    let tolerance = tolerance(section, usual, rest);
    let conditions = conditions(section, columns);
    Some(Requirement {
        conditions: conditions?,
        probability: probability?,
        tolerance: tolerance?,
    })
}

fn probability(section: &Section) -> Option<f64> {
    if !section.has("probability") {
        return Some(PROBABILITY);
    }
    let allowed = "a share of missions above 0 and below 1, such as 0.95";
    section.number_if("probability", allowed, |share| share > 0.0 && share < 1.0)
}

fn tolerance(section: &Section, usual: f64, rest: f64) -> Option<f64> {
    if !section.has("tolerance") {
        return Some(usual);
    }
    let allowed = format!(
        "a number above 0 and below {}, which is 1 - probability",
        (rest * 1e12).round() / 1e12
    );
    section.number_if("tolerance", &allowed, |tolerance| {
        tolerance > 0.0 && tolerance <= rest + 1e-12
    })
}

/// The list of conditions; all errors are reported.
fn conditions(section: &Section, columns: &ConditionColumns) -> Option<Vec<(String, Condition)>> {
    let Some(Value::List(items)) = section.value("all") else {
        section.error("all", "a list of conditions, such as [\"time_s <= 1200\"]");
        return None;
    };
    if items.is_empty() || items.len() > MAX_CONDITIONS {
        let allowed = format!("a list of 1 to {MAX_CONDITIONS} conditions");
        section.error("all", &allowed);
        return None;
    }
    let read = |(index, item): (usize, &Node)| {
        let read = condition(item, columns);
        read.map_err(|error| {
            let path = format!("{}[{index}]", section.path_of("all"));
            section.report("all", InputError { path, ..error });
        })
        .ok()
    };
    let read: Vec<Option<_>> = items.iter().enumerate().map(read).collect();
    read.into_iter().collect()
}

/// One condition; the path of the error is missing.
fn condition(item: &Node, columns: &ConditionColumns) -> Result<(String, Condition), InputError> {
    let refused =
        |allowed: String| InputError::new(String::new(), Some(item.value.to_string()), allowed);
    let Value::Text(text) = &item.value else {
        return Err(refused(
            "a condition, such as \"time_s <= 1200\"".to_owned(),
        ));
    };
    let parsed = parse(text, columns).map_err(|error| InputError {
        suggestion: error.suggestion,
        ..refused(error.allowed)
    })?;
    let unseen = columns
        .unseen
        .iter()
        .find(|unseen| unseen.place == parsed.place);
    match unseen.filter(|unseen| parsed.needs_beyond(unseen.seen)) {
        Some(unseen) => Err(refused(format!(
            "a condition on what happens until [end] ends a run, when {}",
            unseen.end
        ))),
        None => Ok((text.trim().to_owned(), parsed)),
    }
}
