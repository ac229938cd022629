//! Warnings about goals that no robot will serve, and radios that are too narrow.

use super::*;

/// Two rovers that serve the goals of three controllers.
const JOB: &str = r#"
clock = { time_limit_s = 60 }
world = { size_m = [10, 10] }
[robots.rover]
count = 2
radius_m = 0.2
drive = { max_speed_m_s = 0.5, max_turn_rate_deg_s = 90 }
radio = { range_m = 20 }
sensors = { gps = { kind = "position" }, compass = { kind = "heading" } }
brain = { behaviours = [{ kind = "serve" }] }
[controllers.base]
count = 3
radio = { range_m = 20 }
[goals.spot]
count = 4
"#;

/// The warnings for the scenario in which parts are replaced.
fn warnings_with(changes: &[(&str, &str)]) -> String {
    let mut text = JOB.to_owned();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let document = Document::parse("t.toml", &text).unwrap();
    ScenarioSpec::read(&document).unwrap_or_else(|errors| panic!("{errors}"));
    let found = warnings(&document, &[Vec::new()]);
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    found.join("\n")
}

#[test]
fn goals_that_robots_serve_have_no_warning() {
    assert_eq!(warnings_with(&[]), "");
    assert_eq!(
        warnings_with(&[("[controllers.base]", "[controllers.base]\nfailed = [0]")]),
        ""
    );
}

#[test]
fn controllers_or_robots_that_have_all_failed_have_a_warning() {
    let controllers = warnings_with(&[(
        "[controllers.base]",
        "[controllers.base]\nfailed = [0, 1, 2]",
    )]);
    assert!(
        controllers.contains("controllers = {...}: all controllers have failed"),
        "{controllers}"
    );
    let out = "[robots.rover]\nfailed = [1]\nout_of_service = [0]";
    let robots = warnings_with(&[("[robots.rover]", out)]);
    assert!(
        robots.contains("robots = {...}: all robots have failed or are out of service"),
        "{robots}"
    );
}

#[test]
fn controllers_that_award_or_own_nothing_have_a_warning() {
    let none = warnings_with(&[(
        "[controllers.base]",
        "[controllers.base]\nallocation = \"none\"",
    )]);
    assert!(
        none.contains("controllers.base.allocation = \"none\": no goal is awarded"),
        "{none}"
    );
    let zero = warnings_with(&[("[controllers.base]", "[controllers.base]\nmax_goals = 0")]);
    assert!(
        zero.ends_with("controllers.base.max_goals = 0: these controllers refuse all goals"),
        "{zero}"
    );
}

#[test]
fn a_search_without_a_detector_of_items_has_a_warning() {
    let search = ("count = 4", "count = 4\nwork = \"search\"");
    let blind = warnings_with(&[search]);
    assert!(
        blind.contains("goals.spot.work = \"search\": no robot with the behaviour serve"),
        "{blind}"
    );
    let eye = "sensors = { eye = { kind = \"items\", range_m = 2 },";
    assert_eq!(warnings_with(&[search, ("sensors = {", eye)]), "");
}

#[test]
fn a_radio_that_is_too_narrow_to_renew_all_leases_has_a_warning() {
    let many = ("count = 4", "count = 1500");
    let narrow = warnings_with(&[many]);
    assert!(
        narrow
            .contains("controllers.base.radio.messages_per_step: fewer than the 9 that 500 goals"),
        "{narrow}"
    );
    let wide = (
        "count = 3\nradio = { range_m = 20 }",
        "count = 3\nradio = { range_m = 20, messages_per_step = 9 }",
    );
    assert_eq!(warnings_with(&[many, wide]), "");
    // A controller that owns its goals alone renews nothing.
    let single = (
        "[controllers.base]\ncount = 3",
        "[controllers.base]\ncount = 1",
    );
    assert_eq!(warnings_with(&[many, single]), "");
    let alone = ("count = 3", "count = 3\nbackup = \"none\"");
    assert_eq!(warnings_with(&[many, alone]), "");
}

#[test]
fn controllers_of_which_no_majority_is_left_have_a_warning() {
    let base = "[controllers.base]\ncount = 3";
    let two = warnings_with(&[(base, "[controllers.base]\ncount = 2")]);
    assert!(
        two.contains("controllers.base.count = 2: each needs the vote of the other"),
        "{two}"
    );
    let alone = "[controllers.base]\ncount = 2\nbackup = \"none\"";
    assert_eq!(warnings_with(&[(base, alone)]), "");
    let failed = warnings_with(&[(base, "[controllers.base]\ncount = 3\nfailed = [0, 2]")]);
    assert!(
        failed.contains("1 of 3 work, which is no majority"),
        "{failed}"
    );
}

#[test]
fn controllers_out_of_range_of_a_majority_have_a_warning() {
    let base = "[controllers.base]\ncount = 3";
    let at = |places: &str| {
        format!("[controllers.base]\ncount = 3\nstart = {{ kind = \"fixed\", at_m = {places} }}")
    };
    let size = ("size_m = [10, 10]", "size_m = [100, 10]");
    let radio = (
        "radio = { range_m = 20 }\nsensors",
        "radio = { range_m = 200 }\nsensors",
    );
    let with = |places: &str| warnings_with(&[(base, &at(places)), size, radio]);
    assert_eq!(with("[[1, 1], [11, 1], [21, 1]]"), "");
    let far = with("[[1, 1], [40, 1], [80, 1]]");
    assert!(
        far.contains("no controller reaches a majority of the 3"),
        "{far}"
    );
    let some = with("[[1, 1], [11, 1], [80, 1]]");
    assert!(
        some.contains("radio.range_m = 20: 1 of the 3 controllers do not reach a majority of them"),
        "{some}"
    );
}
