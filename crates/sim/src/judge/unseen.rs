//! What the runs of a scenario cannot show, because they end at a number of finds, of served goals, of acts on items
//! or of lost robots.

use super::find_times::{find_time, find_times};
use crate::end::{Count, EndCondition};
use crate::scenario::ScenarioSpec;
use base::document::{Document, Value};
use base::scenario::condition::{Operator, Unseen};

/// A kind of items.
struct Kind {
    name: String,
    /// The largest number of them in a run.
    count: u32,
    /// Whether all runs have as many.
    is_fixed: bool,
    /// Whether they are targets; `None` if the configurations of a study differ.
    is_target: Option<bool>,
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
        None if end.count == Count::Left => left(&end, &kinds),
        None => rising(&end).into_iter().collect(),
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
            is_target: is_target(document, &name),
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

fn is_target(document: &Document, kind: &str) -> Option<bool> {
    let factor = format!("items.{kind}.target");
    let is_varied = document.get(&["study", "vary", &factor]).is_some();
    let node = document.get(&["items", kind, "target"]);
    let value = node.is_none_or(|node| node.value != Value::Bool(false));
    (!is_varied).then_some(value)
}

/// The count at a number of which a run ends, and what is known of it: of counts that only rise.
fn rising(end: &EndCondition) -> Option<(String, (f64, f64))> {
    let name = match end.count {
        Count::Served => "served",
        Count::Marked => "marked",
        Count::Confirmed => "confirmed",
        Count::Neutralised => "neutralised",
        Count::RobotsLost => "robots_lost",
        _ => return None,
    };
    Some((name.to_owned(), (0.0, reached(end)?)))
}

/// What is known of the targets that are left, and of those that charges destroyed, if a run ends at a number of targets
/// that are left. Nothing is unknown if runs differ in their number of targets: some may begin with fewer.
fn left(end: &EndCondition, kinds: &[Kind]) -> Vec<(String, (f64, f64))> {
    let number = end.comparison.number;
    let least = match end.comparison.operator {
        Operator::AtMost | Operator::Equal => number.floor(),
        Operator::Below => number.ceil() - 1.0,
        _ => return Vec::new(),
    };
    let targets = kinds.iter().filter(|kind| kind.is_target != Some(false));
    let all = targets
        .clone()
        .map(|kind| f64::from(kind.count))
        .sum::<f64>();
    let is_fixed = targets
        .clone()
        .all(|kind| kind.is_fixed && kind.is_target.is_some());
    if !is_fixed || least < 0.0 {
        return Vec::new();
    }
    let least = least.min(all);
    vec![
        ("left".to_owned(), (least, f64::INFINITY)),
        ("neutralised".to_owned(), (0.0, all - least)),
    ]
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
