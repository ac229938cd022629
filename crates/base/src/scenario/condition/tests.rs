use super::*;
use proptest::prelude::*;
use std::ops::Range;

const NAMES: [&str; 5] = [
    "time_s",
    "collisions",
    "found",
    "found_parcel",
    "missed_half-size",
];

fn columns(times: &[(&str, Range<usize>)]) -> ConditionColumns {
    let times = times.iter().map(|(count, places)| TimesUntil {
        count: (*count).to_owned(),
        places: places.clone(),
    });
    ConditionColumns {
        names: NAMES.map(str::to_owned).into(),
        times: times.collect(),
        unseen: Vec::new(),
    }
}

fn read(text: &str) -> Result<Condition, ConditionError> {
    parse(
        text,
        &columns(&[("found_parcel", 5..14), ("found", 14..78)]),
    )
}

/// What is expected according to the error of an invalid condition, and the suggestion.
fn error(text: &str) -> (String, Option<String>) {
    let error = read(text).unwrap_err();
    let such_as = "a condition, such as \"found >= 3\"; expected ";
    let expected = error.allowed.strip_prefix(such_as).unwrap();
    (expected.to_owned(), error.suggestion)
}

#[test]
fn a_condition_compares_a_column_with_a_number() {
    for (text, place, operator, number) in [
        ("found_parcel >= 9", 3, Operator::AtLeast, 9.0),
        ("time_s<=1200.5", 0, Operator::AtMost, 1200.5),
        (" collisions  <\t1e3 ", 1, Operator::Below, 1000.0),
        ("time_s > -2", 0, Operator::Above, -2.0),
        ("missed_half-size==0", 4, Operator::Equal, 0.0),
        ("found != +4", 2, Operator::NotEqual, 4.0),
    ] {
        let quantity = Quantity::Column(NAMES[place].to_owned());
        let expected = Condition {
            quantity,
            place,
            operator,
            number,
        };
        assert_eq!(read(text), Ok(expected), "{text}");
    }
}

#[test]
fn the_time_until_a_count_reaches_a_number_has_a_column_of_its_own() {
    for (text, place) in [
        ("time_until(found_parcel >= 1) <= 1200", 5),
        ("time_until ( found_parcel>=9 )<=1200", 13),
        ("time_until(found >= 64) <= 1200", 77),
    ] {
        let condition = read(text).unwrap();
        assert_eq!(condition.place, place, "{text}");
        let mut values = [f64::NAN; 78];
        values[place] = 1200.0;
        assert!(condition.holds(&values));
        values[place] = f64::INFINITY;
        assert!(!condition.holds(&values), "it never happened");
    }
}

#[test]
fn a_condition_holds_as_its_operator_compares() {
    let values = [-1.0, 0.0, 3.0, f64::INFINITY];
    for ((written, _), expected) in Operator::ALL.iter().zip([
        [true, true, true, false],
        [false, false, true, true],
        [true, true, false, false],
        [false, false, false, true],
        [false, false, true, false],
        [true, true, false, true],
    ]) {
        let condition = read(&format!("time_s {written} 3")).unwrap();
        assert_eq!(values.map(|value| condition.holds(&[value])), expected);
    }
}

#[test]
fn no_condition_holds_for_a_quarantined_run_or_without_its_value() {
    for (written, _) in Operator::ALL {
        let condition = read(&format!("collisions {written} 0")).unwrap();
        assert!(!condition.holds(&[f64::NAN; 5]), "{written}");
        assert!(!condition.holds(&[0.0]), "{written}");
    }
}

#[test]
fn an_unknown_column_is_reported_with_the_known_ones_and_the_nearest() {
    let names = "one of time_s, collisions, found, found_parcel, missed_half-size or \
                 time_until(found_parcel >= 1) at character ";
    let (expected, suggestion) = error("  found_parcle >= 9");
    assert_eq!(expected, format!("{names}3"));
    assert_eq!(suggestion.unwrap(), "\"  found_parcel >= 9\"");
    let (expected, suggestion) = error("time <= 1200");
    assert_eq!(expected, format!("{names}1"));
    assert_eq!(suggestion.unwrap(), "\"time_s <= 1200\"");
    assert_eq!(error(">= 9").1, None);
}

#[test]
fn what_is_wrong_first_is_reported_with_its_position_and_the_fix() {
    let operators = "an operator (<=, >=, <, >, == or !=)";
    let count = ">= (the time at which the count reached a number)";
    for (text, expected, at, suggestion) in [
        ("found => 9", operators, "character 7", "\"found >= 9\""),
        ("found ≤ 9", operators, "character 7", "\"found <= 9\""),
        ("found = 9", operators, "character 7", "\"found == 9\""),
        ("found", operators, "the end", ""),
        ("found 9", operators, "character 7", ""),
        ("found >= many", "a number", "character 10", ""),
        ("found >= nan", "a number", "character 10", ""),
        ("found >= 1e999", "a number", "character 10", ""),
        ("found >=", "a number", "the end", ""),
        (
            "time_until(found => 2) < 1",
            count,
            "character 18",
            "\"time_until(found >= 2) < 1\"",
        ),
        ("time_until(found > 2) < 1", count, "character 18", ""),
        ("time_until found >= 2 < 1", "'('", "character 12", ""),
        ("time_until(found >= 2 < 1", "')'", "character 23", ""),
        (
            "time_until(found_parcel >= 10) < 1",
            "a whole number from 1 to 9",
            "character 28",
            "",
        ),
        (
            "time_until(found >= 1.5) < 1",
            "a whole number from 1 to 64",
            "character 21",
            "",
        ),
        (
            "time_until(found_parsel >= 1) < 1",
            "one of found_parcel, found",
            "character 12",
            "\"time_until(found_parcel >= 1) < 1\"",
        ),
        (
            "found >= 3 and time_s < 2",
            "nothing more: a condition is one comparison",
            "character 12",
            "",
        ),
    ] {
        let suggestion = (!suggestion.is_empty()).then(|| suggestion.to_owned());
        let expected = format!("{expected} at {at}");
        assert_eq!(error(text), (expected, suggestion), "{text}");
    }
}

#[test]
fn without_columns_of_times_there_is_no_time_until() {
    let error = parse("time_until(found >= 2) < 1", &columns(&[])).unwrap_err();
    assert!(error.allowed.ends_with("missed_half-size at character 1"));
}

/// Any condition on the columns.
fn conditions() -> impl Strategy<Value = Condition> {
    let columns = (0..NAMES.len()).prop_map(|place| {
        let quantity = Quantity::Column(NAMES[place].to_owned());
        (quantity, place)
    });
    let times = (1_usize..=9).prop_map(|number| {
        let count = "found_parcel".to_owned();
        (Quantity::TimeUntil { count, number }, 4 + number)
    });
    let numbers = any::<f64>().prop_filter("finite", |number| number.is_finite());
    let operators = (0..Operator::ALL.len()).prop_map(|number| Operator::ALL[number].1);
    (prop_oneof![columns, times], operators, numbers).prop_map(
        |((quantity, place), operator, number)| Condition {
            quantity,
            place,
            operator,
            number,
        },
    )
}

proptest! {
    #[test]
    fn a_printed_condition_is_parsed_as_the_same_condition(condition in conditions()) {
        prop_assert_eq!(read(&condition.to_string()), Ok(condition));
    }

    #[test]
    fn any_text_is_a_condition_or_an_error(text in "\\PC*") {
        let _ = read(&text);
    }

    #[test]
    fn any_sequence_of_tokens_is_a_condition_or_an_error(
        tokens in prop::collection::vec(
            prop::sample::select(vec!["found", "time_until", "(", ")", ">=", "≤", "=", "3", "-1e9", " ", "\u{3000}", "é"]),
            0..12,
        )
    ) {
        let text = tokens.concat();
        if let Ok(condition) = read(&text) {
            prop_assert_eq!(read(&condition.to_string()), Ok(condition));
        }
    }
}
