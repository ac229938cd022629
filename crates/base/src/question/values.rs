//! The values that one factor takes, as a text.

use crate::document::Value;

/// Values that one factor may have.
const MAX_VALUES: usize = 10_000;

/// What a text of values must be.
pub(super) const ALLOWED: &str = "a text of values, such as \"1..40\" (both ends included), \"1,2,4\", \"0.5,1.0\" or \
     \"touch,ahead\", or of a range of any numbers, such as \"41.0..57.0\"";

/// What a factor takes.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// These: numbers in ascending order, else in the order given, each once.
    Listed(Vec<Value>),
    /// Any number from the first to the second.
    Between(f64, f64),
}

/// The values of a text, or `None` if it is none.
pub(super) fn values(text: &str) -> Option<Values> {
    between(text).or_else(|| listed(text).map(Values::Listed))
}

/// A range with a decimal point at either end.
fn between(text: &str) -> Option<Values> {
    let (low, high) = text.split_once("..")?;
    let ends = [number(low)?, number(high)?];
    let has_point = ends.iter().any(|end| matches!(end, Value::Float(_)));
    let [low, high] = [as_f64(&ends[0])?, as_f64(&ends[1])?];
    (has_point && low < high).then_some(Values::Between(low, high))
}

fn listed(text: &str) -> Option<Vec<Value>> {
    let mut values = Vec::new();
    for part in text.split(',') {
        match part.split_once("..") {
            Some((low, high)) => values.extend(whole_numbers(low, high)?),
            None => values.push(number(part).or_else(|| word(part))?),
        }
    }
    (values.len() <= MAX_VALUES).then(|| in_order(values))
}

fn whole_numbers(low: &str, high: &str) -> Option<Vec<Value>> {
    let (Value::Integer(low), Value::Integer(high)) = (number(low)?, number(high)?) else {
        return None;
    };
    let count = usize::try_from(high.checked_sub(low)?).ok()?;
    (count < MAX_VALUES).then(|| (low..=high).map(Value::Integer).collect())
}

/// A finite number that begins with a digit or a sign: `.3` is a slip of `1...3`.
fn number(text: &str) -> Option<Value> {
    let text = text.trim();
    let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text);
    if !unsigned.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let float = || text.parse().ok().filter(|number: &f64| number.is_finite());
    let whole = text.parse().ok().map(Value::Integer);
    whole.or_else(|| float().map(Value::Float))
}

fn word(text: &str) -> Option<Value> {
    let text = text.trim();
    let is_in_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let is_word = text.starts_with(|c: char| c.is_ascii_alphabetic());
    (is_word && text.chars().all(is_in_word)).then(|| match text {
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        _ => Value::Text(text.to_owned()),
    })
}

/// Each once; all numbers ascending, anything else as it came.
fn in_order(values: Vec<Value>) -> Vec<Value> {
    let numbers: Option<Vec<f64>> = values.iter().map(as_f64).collect();
    if let Some(numbers) = numbers {
        let mut pairs: Vec<(f64, Value)> = numbers.into_iter().zip(values).collect();
        pairs.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        pairs.dedup_by(|(one, _), (other, _)| one.total_cmp(other).is_eq());
        return pairs.into_iter().map(|(_, value)| value).collect();
    }
    let mut once: Vec<Value> = Vec::new();
    for value in values {
        if !once.contains(&value) {
            once.push(value);
        }
    }
    once
}

#[expect(
    clippy::cast_precision_loss,
    reason = "numbers that no factor can take are told when they are tried"
)]
fn as_f64(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> String {
        match values(text) {
            None => "none".to_owned(),
            Some(Values::Between(low, high)) => format!("{low} to {high}"),
            Some(Values::Listed(values)) => {
                let values: Vec<String> = values.iter().map(ToString::to_string).collect();
                values.join(" ")
            }
        }
    }

    #[test]
    fn values_are_ranges_lists_and_mixtures() {
        for (text, expected) in [
            ("1..3", "1 2 3"),
            ("7", "7"),
            (" 4, 2,4 ", "2 4"),
            ("1..2,9", "1 2 9"),
            ("-1..1", "-1 0 1"),
            ("1.0,0.5,1", "0.5 1.0"),
            ("41.0..57.0", "41 to 57"),
            ("41..57.5", "41 to 57.5"),
            ("touch,ahead,touch", "\"touch\" \"ahead\""),
            ("within-2", "\"within-2\""),
            ("false, true", "false true"),
        ] {
            assert_eq!(shown(text), expected, "{text}");
        }
    }

    #[test]
    fn a_text_that_is_no_values_is_none() {
        for text in [
            "",
            "3..1",
            "1...3",
            "0...3",
            "1..",
            "..3",
            "1,,2",
            "2.0..1.0",
            "1.0..2.0,3",
            "3,1.0..2.0",
            "nan..1.0",
            "1.0..inf",
            "1e999",
            "a b",
            "a..b",
            "1..10001",
            "1..9223372036854775807",
            "-9223372036854775808..9223372036854775807",
        ] {
            assert_eq!(shown(text), "none", "{text}");
        }
    }
}
