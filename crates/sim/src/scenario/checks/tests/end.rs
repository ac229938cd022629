//! Conditions with which a run is complete.

use super::super::super::ScenarioSpec;
use super::{GOOD, error, read};
use base::document::Document;

/// The error of a condition in the valid scenario, which has two mines.
fn refusal(when: &str) -> String {
    let end = format!("[end]\nwhen = {when:?}\n[terrain.mud]");
    let reported = error("[terrain.mud]", &end);
    let start = format!("end.when = {when:?}: must be a condition");
    let rest = reported.strip_prefix(&start);
    rest.unwrap_or_else(|| panic!("{reported}")).to_owned()
}

#[test]
fn a_run_is_complete_with_a_condition_on_a_count() {
    for when in [
        "found_mine >= 2",
        "missed == 0",
        "robots_stopped >= 3",
        "false_alarms > 4",
    ] {
        assert!(
            read(&format!("{GOOD}\n[end]\nwhen = {when:?}")).is_ok(),
            "{when}"
        );
    }
}

#[test]
fn a_condition_that_holds_at_the_start_is_refused() {
    for (when, start) in [
        ("found_mine >= 0", "found_mine is 0"),
        ("missed_mine <= 2", "missed_mine is 2"),
        ("missed > 1", "missed is 2"),
        ("collisions < 5", "collisions is 0"),
        ("robots_stopped != 1", "robots_stopped is 0"),
    ] {
        let expected = format!(" that does not hold at the start of a run, where {start}");
        assert_eq!(refusal(when), expected, "{when}");
    }
}

#[test]
fn a_condition_that_can_never_hold_is_refused() {
    for (when, range) in [
        (
            "found_mine >= 3",
            "found_mine is a whole number from 0 to 2",
        ),
        ("found > 2", "found is a whole number from 0 to 2"),
        ("missed < 0", "missed is a whole number from 0 to 2"),
        (
            "robots_stopped >= 4",
            "robots_stopped is a whole number from 0 to 3",
        ),
        ("found == 1.5", "found is a whole number from 0 to 2"),
        (
            "collisions == -1",
            "collisions is a whole number of 0 or more",
        ),
    ] {
        assert_eq!(refusal(when), format!(" that can hold: {range}"), "{when}");
    }
}

#[test]
fn what_is_not_counted_during_a_run_cannot_end_it() {
    let counts = "expected one of found, missed, false_alarms, collisions, robots_stopped, \
                  found_mine, missed_mine at character 1";
    let start = ", such as \"found >= 3\"; ";
    for (when, hint) in [
        ("energy_j >= 100", ""),
        ("failed == 1", ""),
        ("price > 3", ""),
        ("time_s >= 100", "; clock.time_limit_s limits the time"),
        (
            "time_until(found_mine >= 1) < 9",
            "; clock.time_limit_s limits the time",
        ),
        ("found_mnie >= 1", "; did you mean \"found_mine >= 1\"?"),
    ] {
        assert_eq!(refusal(when), format!("{start}{counts}{hint}"), "{when}");
    }
}

#[test]
fn a_condition_can_hold_if_it_can_in_any_configuration_of_the_study() {
    let with = |when: &str, vary: &str| {
        let text = format!("{GOOD}\n[end]\nwhen = {when:?}\n[study]\nvary = {{ {vary} }}");
        let anywhere = text.replace(
            "kind = \"fixed\", at_m = [[5, 5], [19, 9]]",
            "kind = \"uniform\"",
        );
        let document = Document::parse("t", &anywhere).unwrap();
        ScenarioSpec::read(&document).is_ok()
    };
    let mines = "\"items.mine.count\" = \"1..6\"";
    assert!(with("found_mine >= 6", mines));
    assert!(with("found >= 6", mines));
    assert!(!with("found_mine >= 7", mines));
    assert!(with(
        "robots_stopped >= 6",
        "\"robots.rover.count\" = \"1,5\""
    ));
}

#[test]
fn the_end_needs_a_condition() {
    let reported = error("[terrain.mud]", "[end]\n[terrain.mud]");
    assert!(reported.starts_with("end.when is missing"), "{reported}");
    let reported = error("[terrain.mud]", "[end]\nwhen = 3\n[terrain.mud]");
    assert!(
        reported.starts_with("end.when = 3: must be a"),
        "{reported}"
    );
}
