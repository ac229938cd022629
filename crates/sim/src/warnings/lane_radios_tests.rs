use super::lane_radios::warnings;
use crate::scenario::ScenarioSpec;
use base::document::Document;

/// The warnings of the bundled scenario with other radios of robots and controllers, and numbers of controllers.
fn with(robots: u32, controllers: u32, count: u32) -> Vec<String> {
    let text = include_str!("../../../../scenarios/mines.toml");
    let (before, after) = text.split_once("[controllers.station]").unwrap();
    let radio = "messages_per_step = 200";
    assert_eq!(
        [before, after].map(|part| part.matches(radio).count()),
        [2, 1]
    );
    let before = before.replace(radio, &format!("messages_per_step = {robots}"));
    let after = after.replace(radio, &format!("messages_per_step = {controllers}"));
    let after = after.replace("count = 2", &format!("count = {count}"));
    let text = format!("{before}[controllers.station]{after}");
    let document = Document::parse("t.toml", &text).unwrap();
    let checked = ScenarioSpec::read(&document).unwrap();
    let found = warnings(&checked, &document.place());
    found.iter().map(ToString::to_string).collect()
}

#[test]
fn radios_that_are_too_narrow_for_the_reports_about_a_lane_have_a_warning() {
    let none: [&str; 0] = [];
    assert_eq!(with(200, 200, 2), none);
    // Eighteen messages to each of two controllers. In each of five steps, one of two and at most two of six robots.
    assert_eq!(with(36, 54, 2), none);
    let of_robots = with(35, 54, 2);
    assert!(
        of_robots.len() == 2 && of_robots[1].contains("robots.ugv.radio.messages_per_step = 35")
    );
    assert_eq!(with(18, 54, 1), none);
    let of_controllers = with(36, 4, 2);
    assert_eq!(of_controllers.len(), 1);
    assert!(
        of_controllers[0]
            .contains("controllers.station.radio.messages_per_step = 4: fewer than the 54")
    );
}
