//! Which outcomes of a mined lane a requirement admits.

use crate::scenario::spec::ScenarioSpec;
use base::document::{Node, Value};
use base::scenario::condition::{Condition, ConditionColumns, parse};

/// An outcome: a column has one value, or any that is not known here.
type Outcome = [(&'static str, Option<f64>)];

/// Whether only outcomes in which the lane is declared clear, and is clear, meet all conditions. Conditions on columns
/// that do not depend on the declaration alone exclude no outcome.
pub(super) fn need_clear(conditions: &[Node], spec: &ScenarioSpec) -> bool {
    let limit_s = spec.clock.time_limit_s;
    // Without a condition of its own, a run is complete when the lane is declared clear.
    let by_declaration = |failed: f64, time_s: Option<f64>| {
        let is_default = spec.end.is_none();
        [
            ("failed", Some(failed).filter(|_| is_default)),
            ("time_s", time_s.filter(|_| is_default)),
        ]
    };
    let outcome = |[declared, clear, not_clear]: [f64; 3]| {
        let is_declared = declared > 0.0;
        let [failed, time] = if is_declared {
            by_declaration(0.0, None)
        } else {
            by_declaration(1.0, Some(f64::INFINITY))
        };
        [
            ("declared", Some(declared)),
            ("declared_clear", Some(clear)),
            ("declared_not_clear", Some(not_clear)),
            ("declared_s", (!is_declared).then_some(limit_s)),
            ("given_up", is_declared.then_some(0.0)),
            ("given_up_s", is_declared.then_some(limit_s)),
            failed,
            time,
        ]
    };
    let [none, clear, not_clear] = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0]].map(outcome);
    let columns = ConditionColumns {
        names: clear.iter().map(|(name, _)| (*name).to_owned()).collect(),
        ..ConditionColumns::default()
    };
    let texts = conditions.iter().filter_map(|node| match &node.value {
        Value::Text(text) => Some(text),
        _ => None,
    });
    let conditions: Vec<Condition> = texts
        .filter_map(|text| parse(text, &columns).ok())
        .collect();
    let is_met = |outcome: &Outcome| {
        conditions
            .iter()
            .all(|condition| admits(condition, outcome))
    };
    is_met(&clear) && !is_met(&none) && !is_met(&not_clear)
}

fn admits(condition: &Condition, outcome: &Outcome) -> bool {
    let value = outcome.get(condition.place).and_then(|(_, value)| *value);
    value.is_none_or(|value| condition.holds_for(value))
}
