//! Blind shares, sensor models and confusion matrices.

use super::*;

const EYE: &str = "robots.rover.sensors.eye";

/// The valid scenario with more lines for its item detector, and with clutter.
fn with(lines: &str) -> String {
    GOOD.replace("range_m = 3", &format!("range_m = 3\n{lines}"))
        .replace("[items.mine]", "[items.clutter]\ncount = 1\n[items.mine]")
        .replace("{ mine = [[0", "{ clutter = 0.5, mine = [[0")
}

#[test]
fn blind_shares_models_and_confusion_are_optional() {
    let lines = "blind_share = { mine = 0.05, clutter = 1 }\nmodel = \"magnetometer\"\n\
                 confusion = { mine = { mine = 0.9, clutter = 0.1 } }";
    assert_eq!(errors_in(&with(lines)), [""; 0]);
    assert_eq!(
        errors_in(&with("blind_share = {}\nconfusion = {}")),
        [""; 0]
    );
}

#[test]
fn all_errors_of_blind_shares_and_confusion_are_reported_at_once() {
    let lines = "blind_share = { mien = 0.1, mine = 1.5, clutter = -0.1 }\nmodel = \"a b\"\n\
                 [robots.rover.sensors.eye.confusion]\nmine = { mine = 0.9, clutter = 0.2 }\n\
                 cluter = { mine = 1 }\nclutter = { clutter = 1.2, mien = -0.2 }\n\
                 [robots.rover.sensors.eye]";
    let (shares, table) = lines.split_once("\n[").unwrap();
    let text = with(shares);
    let table = table.trim_end_matches("[robots.rover.sensors.eye]");
    let reported = errors_in(&format!("{text}\n[{table}"));
    let known = "is not a known key: expected one of clutter, mine; did you mean";
    let expected = [
        format!("{EYE}.blind_share.clutter = -0.1: must be a number from 0 to 1"),
        format!("{EYE}.blind_share.mien {known} mine?"),
        format!("{EYE}.blind_share.mine = 1.5: must be a number from 0 to 1"),
        format!("{EYE}.confusion.cluter {known} clutter?"),
        format!("{EYE}.confusion.clutter.clutter = 1.2: must be a number from 0 to 1"),
        format!("{EYE}.confusion.clutter.mien {known} mine?"),
        format!("{EYE}.confusion.clutter.mien = -0.2: must be a number from 0 to 1"),
        format!(
            "{EYE}.confusion.mine = {{...}}: must be probabilities that sum to 1, one for \
             each reported kind; they sum to 1.1"
        ),
        format!(
            "{EYE}.model = \"a b\": must be a name of at most 64 letters a to z or A to Z, digits, _ and -"
        ),
    ];
    assert_eq!(reported.len(), expected.len(), "{reported:#?}");
    for error in &expected {
        assert!(
            reported.iter().any(|one| one == error),
            "{error}\n{reported:#?}"
        );
    }
}

#[test]
fn a_row_may_be_off_by_rounding_only() {
    let row = |mine: &str| {
        with(&format!(
            "confusion = {{ mine = {{ mine = {mine}, clutter = 0.1 }} }}"
        ))
    };
    assert_eq!(errors_in(&row("0.9000000001")), [""; 0]);
    assert_eq!(errors_in(&row("0.90000001")).len(), 1);
    let empty = with("confusion = { mine = {} }");
    assert!(errors_in(&empty)[0].contains("they sum to 0"));
}

#[test]
fn values_for_kinds_that_the_sensor_never_detects_are_refused() {
    let lines = "blind_share = { clutter = 0.1 }\nconfusion = { clutter = { mine = 1 } }";
    let text = with(lines).replace("clutter = 0.5, ", "");
    let text = text.replace(
        "count = 1\n[items.mine]",
        "count = 1\ntarget = false\n[items.mine]",
    );
    let end =
        "must be removed, or the kind added to detection_probability: the sensor never detects it";
    let expected = [
        format!("{EYE}.blind_share.clutter = 0.1: {end}"),
        format!("{EYE}.confusion.clutter = {{...}}: {end}"),
    ];
    assert_eq!(errors_in(&text), expected);
}

#[test]
fn shares_of_lookalikes_and_what_is_believed_are_optional() {
    let lines = "lookalike_share = { mine = { clutter = 0.1 }, clutter = {} }\n\
                 believed = { detection_probability = { mine = 0.9 }, blind_share = { clutter = 0.1 }, \
                 lookalike_share = { mine = { clutter = 0 } }, confusion = { mine = { mine = 1 } } }";
    assert_eq!(errors_in(&with(lines)), [""; 0]);
    assert_eq!(
        errors_in(&with("lookalike_share = {}\nbelieved = {}")),
        [""; 0]
    );
}

#[test]
fn all_errors_of_lookalikes_are_reported_at_once() {
    let lines =
        "lookalike_share = { mine = { clutter = 1.5, mien = 0.1, mine = 0.5 }, cluter = {} }";
    let known = "is not a known key: expected one of clutter, mine; did you mean";
    let at = format!("{EYE}.lookalike_share");
    let mut expected = [
        format!("{at}.cluter {known} clutter?"),
        format!("{at}.mine.clutter = 1.5: must be a number from 0 to 1"),
        format!("{at}.mine.mien {known} mine?"),
        format!(
            "{at}.mine.mine = 0.5: must be removed: what looks like no other kind looks like what it is"
        ),
    ];
    let mut reported = errors_in(&with(lines));
    reported.sort();
    expected.sort();
    assert_eq!(reported, expected);
}

/// What is believed has the rules of what is true, with the kinds that the sensor is believed to detect.
#[test]
fn all_errors_of_what_is_believed_are_reported_at_once() {
    let lines = "believed = { detection_probability = { mine = 0.9, rock = 0.1 }, \
                 blind_share = { mine = 2, clutter = 0.1 }, confusion = { mine = { mine = 0.9 } } }";
    let text = with(lines).replace("clutter = 0.5, ", "").replace(
        "count = 1\n[items.mine]",
        "count = 1\ntarget = false\n[items.mine]",
    );
    let at = format!("{EYE}.believed");
    let mut expected = [
        format!(
            "{at}.blind_share.clutter = 0.1: must be removed, or the kind added to detection_probability: the sensor \
             never detects it"
        ),
        format!("{at}.blind_share.mine = 2: must be a number from 0 to 1"),
        format!(
            "{at}.confusion.mine = {{...}}: must be probabilities that sum to 1, one for each reported kind; they sum \
             to 0.9"
        ),
        format!(
            "{at}.detection_probability.rock is not a known key: expected one of clutter, mine"
        ),
    ];
    let mut reported = errors_in(&text);
    reported.sort();
    expected.sort();
    assert_eq!(reported, expected);
    let all = text.replace("rock = 0.1", "clutter = 0.1");
    assert!(
        !errors_in(&all)
            .iter()
            .any(|error| error.contains("clutter"))
    );
}

#[test]
fn a_kind_that_is_only_detected_as_another_one_may_have_a_blind_share() {
    let of = |lines: &str| {
        let text = with(lines).replace("clutter = 0.5, ", "").replace(
            "count = 1\n[items.mine]",
            "count = 1\ntarget = false\n[items.mine]",
        );
        errors_in(&text)
    };
    let blind = "blind_share = { clutter = 0.1 }";
    assert_eq!(of(blind).len(), 1, "{:#?}", of(blind));
    let alike = format!("{blind}\nlookalike_share = {{ clutter = {{ mine = 0.3 }} }}");
    assert_eq!(of(&alike), [""; 0]);
}
