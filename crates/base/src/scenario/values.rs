//! The values of a factor, from a string such as `1..40`.

use crate::document::Value;

/// Maximum number of values of one factor.
const MAX_VALUES: i128 = 10_000;
const MAX_VALUES_F64: f64 = 10_000.0;

/// What is allowed as a string of values.
pub(super) const ALLOWED: &str = "a string of values, such as \"1..40\" (both ends included), \"1..41 by 5\", \"1..1000 log \
     7\" (7 values, each the same multiple of the one before), \"1,2,4\", \"0.5,1.0\" or \"touch,ahead\", or a range of \
     numbers, such as \"41.0..57.0\"";

/// The values of a factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// A list, each value once: numbers in ascending order, others in the given order.
    Listed(Vec<Value>),
    /// Any number from the first to the second, both included.
    Between(f64, f64),
}

/// Parses a string of values.
///
/// # Errors
/// What is allowed.
pub(super) fn values(text: &str) -> Result<Values, String> {
    if let Some(between) = between(text) {
        return Ok(between);
    }
    let parts: Option<Vec<Part>> = text.split(',').map(Part::of).collect();
    let parts = parts.ok_or(ALLOWED)?;
    let count: i128 = parts.iter().map(Part::count).sum();
    if count > MAX_VALUES {
        return Err(format!("at most {MAX_VALUES} values; it has {count}"));
    }
    let values = parts.into_iter().flat_map(Part::values).collect();
    Ok(Values::Listed(in_order(values)))
}

/// The largest number that a string of values lists, without the list.
pub(super) fn largest_of(text: &str) -> Option<f64> {
    if let Some(Values::Between(_, high)) = between(text) {
        return Some(high);
    }
    let parts = text.split(',').filter_map(Part::of);
    let numbers = parts.filter_map(|part| match part {
        Part::One(value) => as_f64(&value),
        Part::Run(_, high) => as_f64(&Value::Integer(high)),
        Part::Spaced(values) => values.iter().filter_map(as_f64).reduce(f64::max),
    });
    numbers.reduce(f64::max)
}

/// A range with a decimal point at either end.
fn between(text: &str) -> Option<Values> {
    let (low, high) = text.split_once("..")?;
    let ends = [number(low)?, number(high)?];
    let has_point = ends.iter().any(|end| matches!(end, Value::Float(_)));
    let [low, high] = [as_f64(&ends[0])?, as_f64(&ends[1])?];
    (has_point && low < high).then_some(Values::Between(low, high))
}

/// A part of the string, between commas.
enum Part {
    One(Value),
    /// Whole numbers from the first to the second, both included.
    Run(i64, i64),
    /// Numbers with a step or a ratio between them.
    Spaced(Vec<Value>),
}

impl Part {
    fn of(text: &str) -> Option<Self> {
        let Some((low, high)) = text.split_once("..") else {
            return number(text).or_else(|| word(text)).map(Self::One);
        };
        if let Some((high, step)) = high.split_once(" by ") {
            return steps(&[number(low)?, number(high)?, number(step)?]).map(Self::Spaced);
        }
        if let Some((high, count)) = high.split_once(" log ") {
            return ratios(&[number(low)?, number(high)?, number(count)?]).map(Self::Spaced);
        }
        match (number(low)?, number(high)?) {
            (Value::Integer(low), Value::Integer(high)) if low <= high => {
                Some(Self::Run(low, high))
            }
            _ => None,
        }
    }

    fn count(&self) -> i128 {
        match self {
            Self::One(_) => 1,
            Self::Run(low, high) => i128::from(*high) - i128::from(*low) + 1,
            Self::Spaced(values) => values.len() as i128,
        }
    }

    fn values(self) -> Vec<Value> {
        match self {
            Self::One(value) => vec![value],
            Self::Run(low, high) => (low..=high).map(Value::Integer).collect(),
            Self::Spaced(values) => values,
        }
    }
}

/// From `low` to `high` in steps; whole numbers if all three are.
fn steps(numbers: &[Value; 3]) -> Option<Vec<Value>> {
    let is_whole = numbers.iter().all(is_integer);
    let [low, high, step] = numbers.each_ref().map(as_f64);
    let (low, high, step) = (low?, high?, step?);
    // Rounding must not lose the last one.
    let count = ((high - low) / step * (1.0 + 1e-12)).floor();
    let is_allowed = step > 0.0 && low <= high && count < MAX_VALUES_F64;
    let at = |place: i32| spaced(low + f64::from(place) * step, is_whole);
    is_allowed.then(|| (0..=as_count(count)).map(at).collect())
}

/// `count` numbers from `low` to `high`, each the same multiple of the one before; rounded to whole
/// numbers if both ends are.
fn ratios(numbers: &[Value; 3]) -> Option<Vec<Value>> {
    let is_whole = numbers[..2].iter().all(is_integer);
    let [low, high, count] = numbers.each_ref().map(as_f64);
    let (low, high, count) = (low?, high?, count?);
    let is_allowed = low > 0.0 && low < high && (2.0..MAX_VALUES_F64).contains(&count);
    let last = count.floor() - 1.0;
    let at = |place: i32| {
        let share = f64::from(place) / last;
        spaced(low * libm::pow(high / low, share), is_whole)
    };
    is_allowed.then(|| (0..=as_count(last)).map(at).collect())
}

fn is_integer(value: &Value) -> bool {
    matches!(value, Value::Integer(_))
}

/// A count that is known to be small.
#[expect(clippy::cast_possible_truncation, reason = "below 10,000")]
fn as_count(count: f64) -> i32 {
    count as i32
}

/// A number with ten significant digits, so that 0.1 + 2 x 0.1 is 0.3; or a whole one.
#[expect(
    clippy::cast_possible_truncation,
    reason = "values beyond are reported when they are checked"
)]
fn spaced(number: f64, is_whole: bool) -> Value {
    if is_whole {
        return Value::Integer(number.round() as i64);
    }
    let rounded = format!("{number:.9e}").parse();
    Value::Float(rounded.unwrap_or(number))
}

/// A finite number that begins with a digit or a sign: `.3` comes from the typing error `1...3`.
pub(super) fn number(text: &str) -> Option<Value> {
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

/// Each value once: numbers in ascending order, others in the given order.
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
    reason = "numbers that no factor can take are reported when they are checked"
)]
pub(super) fn as_f64(value: &Value) -> Option<f64> {
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
            Err(allowed) if allowed == ALLOWED => "none".to_owned(),
            Err(allowed) => allowed,
            Ok(Values::Between(low, high)) => format!("{low} to {high}"),
            Ok(Values::Listed(values)) => {
                let values: Vec<String> = values.iter().map(ToString::to_string).collect();
                values.join(" ")
            }
        }
    }

    #[test]
    fn values_are_ranges_lists_and_mixtures() {
        for (text, expected) in [
            ("1..3", "1 2 3"),
            ("1..10 by 4", "1 5 9"),
            ("0.1..0.5 by 0.1", "0.1 0.2 0.3 0.4 0.5"),
            ("1..1000 log 4", "1 10 100 1000"),
            ("1..4 log 9", "1 2 3 4"),
            ("0.01..1 log 3", "0.01 0.1 1.0"),
            ("1..9 by 4,2", "1 2 5 9"),
            ("1..9 by 0", "none"),
            ("1..9 by -1", "none"),
            ("0..9 log 3", "none"),
            ("1..9 log 1", "none"),
            ("1..9 by", "none"),
            ("1..100000000 by 1", "none"),
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
    fn the_largest_number_of_a_text_is_that_of_its_values() {
        for (text, expected) in [
            ("1..3", Some(3.0)),
            ("9,1..4", Some(9.0)),
            ("-2,0.5", Some(0.5)),
            ("41.0..57.5", Some(57.5)),
            ("1..10000000", Some(1e7)),
            ("touch,ahead", None),
            ("", None),
        ] {
            assert_eq!(largest_of(text), expected, "{text}");
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
        ] {
            assert_eq!(shown(text), "none", "{text}");
        }
    }

    #[test]
    fn too_many_values_are_reported_with_their_number_and_the_limit() {
        for (text, count) in [
            ("1..10001", "10001"),
            ("1..10000,7", "10001"),
            ("1..9223372036854775807", "9223372036854775807"),
            (
                "-9223372036854775808..9223372036854775807",
                "18446744073709551616",
            ),
        ] {
            let expected = format!("at most 10000 values; it has {count}");
            assert_eq!(shown(text), expected, "{text}");
        }
        assert_eq!(values("1..10000").map(|_| ()), Ok(()));
    }
}
