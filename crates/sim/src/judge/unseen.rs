//! What the runs of a scenario cannot show, because they end at a number of finds or of served goals.

use super::find_times::{find_time, find_times};
use crate::end::{Count, EndCondition};
use crate::scenario::ScenarioSpec;
use base::document::{Document, Value};
use base::scenario::condition::{Operator, Unseen};

/// A kind of items: its name, the largest number of them in a run, and whether all runs have as many.
struct Kind {
    name: String,
    count: u32,
    is_fixed: bool,
}

/// The counts and times that are unknown after the end of a document with these columns. Works on documents with
/// errors, too.
pub(crate) fn unseen(document: &Document, columns: &[String]) -> Vec<Unseen> {
    let when = document.get(&["end", "when"]).map(|node| &node.value);
    let Some(Value::Text(text)) = when else {
        return Vec::new();
    };
    let kinds = kinds(document);
    let names = kinds.iter().map(|kind| kind.name.as_str());
    let end = EndCondition::parse(text, names, ScenarioSpec::features(document));
    let Ok(end) = end else {
        return Vec::new();
    };
    let ranges = match finds(&end, &kinds) {
        Some((of, last)) => ranges(&kinds, of, last),
        None => served(&end)
            .map(|last| ("served".to_owned(), (0.0, last)))
            .into_iter()
            .collect(),
    };
    let place = |name: String| columns.iter().position(|known| *known == name);
    let seen = |(name, seen): (String, (f64, f64))| {
        let end = text.trim().to_owned();
        Some(Unseen {
            place: place(name)?,
            seen,
            end,
        })
    };
    ranges.into_iter().filter_map(seen).collect()
}

fn kinds(document: &Document) -> Vec<Kind> {
    let counts = ScenarioSpec::max_counts(document).into_iter();
    let kind = |(name, count): (String, u32)| {
        let factor = format!("items.{name}.count");
        Kind {
            is_fixed: document.get(&["study", "vary", &factor]).is_none()
                && !ScenarioSpec::may_draw_number(document, &name),
            count,
            name,
        }
    };
    counts.map(kind).collect()
}

/// At which number of finds a run ends: of one kind, or of all.
fn finds(end: &EndCondition, kinds: &[Kind]) -> Option<(Option<usize>, f64)> {
    let number = end.comparison.number;
    let last = match (end.count, end.comparison.operator) {
        (Count::Found | Count::FoundOf(_), _) => reached(end)?,
        (Count::MissedOf(of), Operator::AtMost | Operator::Equal) if kinds[of].is_fixed => {
            f64::from(kinds[of].count) - number.floor()
        }
        (Count::MissedOf(of), Operator::Below) if kinds[of].is_fixed => {
            f64::from(kinds[of].count) - (number.ceil() - 1.0)
        }
        _ => return None,
    };
    match end.count {
        Count::FoundOf(of) | Count::MissedOf(of) => Some((Some(of), last)),
        _ => Some((None, last)),
    }
}

/// At which number of served goals a run ends.
fn served(end: &EndCondition) -> Option<f64> {
    reached(end).filter(|_| end.count == Count::Served)
}

/// The smallest number of which a condition holds that a rising count meets.
fn reached(end: &EndCondition) -> Option<f64> {
    let number = end.comparison.number;
    match end.comparison.operator {
        Operator::AtLeast | Operator::Equal => Some(number.ceil()),
        Operator::Above => Some(number.floor() + 1.0),
        _ => None,
    }
}

/// The columns of which something is unknown, each with the range that is known.
fn ranges(kinds: &[Kind], of: Option<usize>, last: f64) -> Vec<(String, (f64, f64))> {
    let mut ranges = Vec::new();
    let mut all = 0.0;
    for (number, kind) in kinds.iter().enumerate() {
        let is_counted = of.is_none_or(|of| of == number);
        let count = f64::from(kind.count);
        let max = if is_counted { last.min(count) } else { count };
        all += max;
        if max < count {
            ranges.extend(ranges_of(kind, max));
        }
    }
    let all = if of.is_none() { all.min(last) } else { all };
    ranges.push(("found".to_owned(), (0.0, all)));
    ranges
}

/// The columns of a kind of which a run shows at most `max` finds.
fn ranges_of(kind: &Kind, max: f64) -> Vec<(String, (f64, f64))> {
    let name = &kind.name;
    let mut ranges = vec![(format!("found_{name}"), (0.0, max))];
    if kind.is_fixed {
        let least = f64::from(kind.count) - max;
        ranges.push((format!("missed_{name}"), (least, f64::INFINITY)));
    }
    let never = (f64::INFINITY, f64::INFINITY);
    let later = (1..=find_times(kind.count)).filter(|find| f64::from(*find) > max);
    ranges.extend(later.map(|find| (find_time(name, find), never)));
    ranges
}
