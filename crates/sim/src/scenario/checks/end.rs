//! Checks that the condition of the end can hold, but not from the start.

use crate::end::{Count, EndCondition};
use crate::scenario::counts::{max_count, max_number};
use crate::scenario::spec::ScenarioSpec;
use crate::world::items::ItemSpec;
use base::document::{Document, Place};
use base::error::InputError;

/// A count at the start of a run, unless runs differ, and the largest that it can be in any configuration of the study.
struct Range {
    start: Option<f64>,
    max: f64,
}

pub(super) fn errors(spec: &ScenarioSpec, document: &Document) -> Vec<InputError> {
    let Some(end) = &spec.end else {
        return Vec::new();
    };
    let at = document.place().key("end").key("when");
    let items = spec.items.keys().map(String::as_str);
    let condition = match EndCondition::parse(&end.when, items, ScenarioSpec::features(document)) {
        Ok(condition) => condition,
        Err(error) => {
            let hint = hint(&end.when);
            let suggestion = error.suggestion;
            return vec![InputError {
                suggestion,
                ..at.error(error.allowed + hint)
            }];
        }
    };
    let range = range(condition.count, spec, document);
    error(&condition, &range, &at).into_iter().collect()
}

/// What to do instead of a condition on the time.
fn hint(text: &str) -> &'static str {
    if text.trim_start().starts_with("time") {
        "; clock.time_limit_s limits the time"
    } else {
        ""
    }
}

fn error(condition: &EndCondition, range: &Range, at: &Place) -> Option<InputError> {
    let quantity = &condition.comparison.quantity;
    let start = range.start;
    if let Some(start) = start.filter(|start| condition.comparison.holds_for(*start)) {
        return Some(at.error(format!(
            "a condition that does not hold at the start of a run, where {quantity} is {start}"
        )));
    }
    let never = !condition.can_hold(range.max);
    never.then(|| {
        let upper = if range.max.is_finite() {
            format!("from 0 to {}", range.max)
        } else {
            "of 0 or more".to_owned()
        };
        at.error(format!(
            "a condition that can hold: {quantity} is a whole number {upper}"
        ))
    })
}

fn range(count: Count, spec: &ScenarioSpec, document: &Document) -> Range {
    let items: Vec<(&String, &ItemSpec)> = spec.items.iter().collect();
    let max = |name: &str| f64::from(max_number(document, name));
    let targets = items.iter().filter(|(_, kind)| kind.target);
    let all_targets = targets.clone().map(|(name, _)| max(name)).sum();
    let (start, max) = match count {
        Count::Missed => {
            let counts = targets.map(|(_, kind)| number(kind));
            (counts.sum(), all_targets)
        }
        Count::Left | Count::LeftOrOpen => {
            let counts = targets.map(|(_, kind)| number(kind));
            (counts.sum(), all_targets)
        }
        Count::Found | Count::Marked | Count::Confirmed | Count::Neutralised => {
            (Some(0.0), all_targets)
        }
        Count::FoundOf(kind) => (Some(0.0), max(items[kind].0)),
        Count::MissedOf(kind) => (number(items[kind].1), max(items[kind].0)),
        Count::Served | Count::Open => {
            let kinds = spec.goals.keys();
            let counts = kinds.map(|name| f64::from(max_count(document, "goals", name)));
            (Some(0.0), counts.sum())
        }
        Count::Declared => (Some(0.0), 1.0),
        Count::FalseAlarms | Count::Collisions => (Some(0.0), f64::INFINITY),
        Count::RobotsStopped | Count::RobotsLost => {
            let kinds = spec.robots.keys();
            let counts = kinds.map(|name| f64::from(max_count(document, "robots", name)));
            (Some(0.0), counts.sum())
        }
    };
    Range { start, max }
}

/// The number of items of a kind in each run, if all runs have the same.
fn number(kind: &ItemSpec) -> Option<f64> {
    kind.is_fixed().then(|| kind.count.into())
}
