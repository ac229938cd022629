//! Parses the text of a condition.

use super::columns::{ConditionColumns, TimesUntil};
use super::comparison::{Condition, Operator, Quantity};
use super::cursor::{ConditionError, Cursor, Token};
use crate::document::Value;
use crate::error::nearest;
use crate::scenario::values::{as_f64, number};

/// The time at which a count reached a number is written `time_until(COUNT >= NUMBER)`.
const TIME_UNTIL: &str = "time_until";

/// What people write for an operator.
const MISSPELT: [(&str, &str); 8] = [
    ("=", "=="),
    ("===", "=="),
    ("=<", "<="),
    ("=>", ">="),
    ("<>", "!="),
    ("≤", "<="),
    ("≥", ">="),
    ("≠", "!="),
];

/// Parses a condition on some columns.
///
/// # Errors
/// What is wrong first, with its position, what is allowed there, and the fix where it is known.
pub fn parse(text: &str, columns: &ConditionColumns) -> Result<Condition, ConditionError> {
    let mut cursor = Cursor::new(text);
    let (quantity, place) = quantity(&mut cursor, columns)?;
    let operator = operator(&mut cursor)?;
    let token = cursor.take(is_in_number);
    let number = number(token.text).and_then(|number| as_f64(&number));
    let number = number.ok_or_else(|| cursor.error_at(token, "a number", None))?;
    cursor.expect_end()?;
    Ok(Condition {
        quantity,
        place,
        operator,
        number,
    })
}

/// A quantity, and the place of its value.
fn quantity(
    cursor: &mut Cursor,
    columns: &ConditionColumns,
) -> Result<(Quantity, usize), ConditionError> {
    let token = cursor.take(is_in_name);
    if token.text == TIME_UNTIL && !columns.times.is_empty() {
        return time_until(cursor, &columns.times);
    }
    let names = columns.names.iter().map(String::as_str);
    let place = names.clone().position(|name| name == token.text);
    let place = place.ok_or_else(|| {
        let times = match &columns.times[..] {
            [] => String::new(),
            [first, ..] => format!(" or {TIME_UNTIL}({} >= 1)", first.count),
        };
        let expected = format!("one of {}{times}", columns.names.join(", "));
        cursor.error_at(token, &expected, nearest(token.text, names))
    })?;
    Ok((Quantity::Column(token.text.to_owned()), place))
}

/// The rest of `time_until(COUNT >= NUMBER)`.
fn time_until(
    cursor: &mut Cursor,
    times: &[TimesUntil],
) -> Result<(Quantity, usize), ConditionError> {
    cursor.expect('(')?;
    let times = count(cursor, times)?;
    let token = cursor.take(is_in_operator);
    if token.text != ">=" {
        let expected = ">= (the time at which the count reached a number)";
        let instead = spelling(token).filter(|operator| *operator == ">=");
        return Err(cursor.error_at(token, expected, instead));
    }
    let number = reached(cursor, times)?;
    cursor.expect(')')?;
    let count = times.count.clone();
    let quantity = Quantity::TimeUntil { count, number };
    Ok((quantity, times.places.start + number - 1))
}

/// A count for which there are columns of times.
fn count<'c>(
    cursor: &mut Cursor,
    times: &'c [TimesUntil],
) -> Result<&'c TimesUntil, ConditionError> {
    let token = cursor.take(is_in_name);
    let count = times.iter().find(|each| each.count == token.text);
    count.ok_or_else(|| {
        let names: Vec<&str> = times.iter().map(|each| each.count.as_str()).collect();
        let instead = nearest(token.text, names.iter().copied());
        cursor.error_at(token, &format!("one of {}", names.join(", ")), instead)
    })
}

/// A number that a count can reach.
fn reached(cursor: &mut Cursor, times: &TimesUntil) -> Result<usize, ConditionError> {
    let token = cursor.take(is_in_number);
    let max = times.places.len();
    let whole = match number(token.text) {
        Some(Value::Integer(whole)) => usize::try_from(whole).ok(),
        _ => None,
    };
    let whole = whole.filter(|whole| (1..=max).contains(whole));
    whole.ok_or_else(|| cursor.error_at(token, &format!("a whole number from 1 to {max}"), None))
}

fn operator(cursor: &mut Cursor) -> Result<Operator, ConditionError> {
    let token = cursor.take(is_in_operator);
    let mut all = Operator::ALL.iter();
    let operator = all.find(|(written, _)| *written == token.text);
    operator.map(|(_, operator)| *operator).ok_or_else(|| {
        let expected = "an operator (<=, >=, <, >, == or !=)";
        cursor.error_at(token, expected, spelling(token))
    })
}

/// The operator that is meant by what is none.
fn spelling(token: Token) -> Option<&'static str> {
    let mut all = MISSPELT.iter();
    let misspelt = all.find(|(misspelt, _)| *misspelt == token.text);
    misspelt.map(|(_, operator)| *operator)
}

fn is_in_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '-'
}

fn is_in_operator(c: char) -> bool {
    matches!(c, '<' | '>' | '=' | '!' | '≤' | '≥' | '≠')
}

fn is_in_number(c: char) -> bool {
    !c.is_whitespace() && c != ')'
}
