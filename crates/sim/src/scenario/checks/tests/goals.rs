//! Goals, their owners, and the robots that can serve them.

use super::{GOOD, errors_in, read};

/// The errors of the valid scenario with radios, two kinds of controllers, and goals of these keys.
fn errors_of(keys: &str) -> Vec<String> {
    let rover = "[robots.rover]\nradio = { range_m = 9 }\ncapabilities = [\"arm\", \"camera\"]\n\
                 brain = { behaviours = [] }\n";
    let text = GOOD.replace("[robots.rover]\n", rover)
        + "[controllers.base]\ncount = 1\nradio = { range_m = 9 }\n\
           [controllers.mast]\ncount = 0\nradio = { range_m = 9 }\n"
        + &format!("[goals.spot]\ncount = 2\n{keys}\n");
    errors_in(&text)
}

fn error_of(keys: &str) -> String {
    let errors = errors_of(&format!("owner = \"base\"\n{keys}"));
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.concat()
}

#[test]
fn goals_have_an_owner_that_exists() {
    assert_eq!(errors_of("owner = \"mast\""), [""; 0]);
    assert!(errors_of("").concat().contains("one of \"base\", \"mast\""));
    let unknown = errors_of("owner = \"bas\"").concat();
    assert!(unknown.ends_with("did you mean \"base\"?"), "{unknown}");
}

#[test]
fn goals_require_a_capability_of_a_robot_with_a_radio() {
    assert_eq!(errors_of("owner = \"base\"\nrequires = \"arm\""), [""; 0]);
    let unknown = error_of("requires = \"amr\"");
    assert_eq!(
        unknown,
        "goals.spot.requires = \"amr\": must be one of \"arm\", \"camera\"; did you mean \"arm\"?"
    );
    let silent = format!("{GOOD}[goals.spot]\ncount = 1\n");
    let errors = read(&silent).unwrap_err().to_string();
    assert!(errors.contains("none has a radio"), "{errors}");
}

#[test]
fn goals_are_at_free_places_that_a_robot_can_reach() {
    let at =
        |x: f64, y: f64| format!("placement = {{ kind = \"fixed\", at_m = [[5, 6], [{x}, {y}]] }}");
    assert_eq!(
        errors_of(&format!("owner = \"base\"\n{}", at(8.0, 8.0))),
        [""; 0]
    );
    assert!(error_of(&at(2.0, 2.0)).contains("not in an obstacle"));
    let few = "placement = { kind = \"fixed\", at_m = [[5, 6]] }";
    assert!(error_of(few).contains("at least 2 places"));
    // A corner that a robot of 0.5 m cannot come within 0.1 m of.
    let corner = format!("{}\nwithin_m = 0.1", at(19.99, 9.99));
    assert!(error_of(&corner).contains("a robot that can serve it can reach within range"));
}

#[test]
fn goals_arrive_before_the_end_of_a_run() {
    assert!(error_of("arrive_s = 121").contains("at most time_limit_s = 120"));
    assert!(error_of("arrive_s = 20\nevery_s = 101").contains("at most 100: the last of 2 goals"));
}

#[test]
fn two_kinds_of_goals_have_different_positions() {
    let same = "placement = { kind = \"fixed\", at_m = [[5, 6], [8, 8]] }\n";
    let twin = format!("{same}[goals.twin]\nowner = \"base\"\ncount = 1\n{same}");
    assert!(error_of(&twin).contains("other positions than those of spot"));
}

#[test]
fn capabilities_are_listed_once() {
    let text = GOOD.replace(
        "[robots.rover]\n",
        "[robots.rover]\ncapabilities = [\"arm\", \"arm\"]\n",
    );
    let errors = read(&text).unwrap_err().to_string();
    assert!(
        errors.contains("robots.rover.capabilities[1] = \"arm\""),
        "{errors}"
    );
}

/// The errors of a rover that serves goals, with some replacements, and goals of these keys.
fn errors_with(replacements: &[(&str, &str)], keys: &str) -> Vec<String> {
    let rover = "[robots.rover]\nradio = { range_m = 9 }\ncapabilities = [\"arm\"]\n\
                 brain = { behaviours = [{ kind = \"serve\" }] }\n";
    let sensors = "[robots.rover.sensors]\ngps = { kind = \"position\" }\n\
                   compass = { kind = \"heading\" }\n[robots.rover.sensors.eye]\n";
    let bird = "[robots.bird]\nradio = { range_m = 9 }\ncapabilities = [\"camera\"]\n\
                brain = { behaviours = [{ kind = \"cruise\" }] }\n";
    let mut text = GOOD
        .replace("[robots.rover]\n", rover)
        .replace("[robots.rover.sensors.eye]\n", sensors)
        .replace("[robots.bird]\n", bird)
        + "[controllers.base]\ncount = 1\nradio = { range_m = 9 }\n"
        + &format!("[goals.spot]\ncount = 2\n{keys}\n");
    for (this, that) in replacements {
        assert!(text.contains(this), "{this}");
        text = text.replace(this, that);
    }
    errors_in(&text)
}

const SERVE: &str = "[{ kind = \"serve\" }]";

#[test]
fn goals_of_controllers_need_robots_that_can_be_awarded_them() {
    assert_eq!(errors_with(&[], ""), [""; 0]);
    let cruise = "[{ kind = \"cruise\" }]";
    let none = errors_with(&[(SERVE, cruise)], "").concat();
    assert!(none.starts_with("goals.spot"), "{none}");
    assert!(
        none.contains("no kind of robots with a count above 0"),
        "{none}"
    );
    // A program drives robots without behaviours.
    assert_eq!(errors_with(&[(SERVE, "[]")], ""), [""; 0]);
    let rover = "count = 2\nradius_m";
    let gone = [(rover, "count = 0\nradius_m")];
    assert!(errors_with(&gone, "").concat().contains("a count above 0"));
    let varied = "[study]\nvary = { \"robots.rover.count\" = \"0..2\" }";
    assert_eq!(errors_with(&gone, varied), [""; 0]);
    let shared = [
        (SERVE, cruise),
        (
            "[controllers.base]\ncount = 1",
            "[controllers.base]\ncount = 0",
        ),
    ];
    assert_eq!(errors_with(&shared, ""), [""; 0]);
}

#[test]
fn goals_of_controllers_need_a_capability_of_robots_that_can_be_awarded_them() {
    assert_eq!(errors_with(&[], "requires = \"arm\""), [""; 0]);
    assert_eq!(
        errors_with(&[], "requires = \"camera\""),
        [
            "goals.spot.requires = \"camera\": must be one of \"arm\" among capabilities of robots with the behaviour serve"
        ]
    );
}

#[test]
fn goals_do_not_expire_before_they_can_be_served() {
    assert_eq!(errors_with(&[], "service_s = 5\ndeadline_s = 5"), [""; 0]);
    let late = errors_with(&[], "service_s = 5\ndeadline_s = 4").concat();
    assert!(
        late.starts_with("goals.spot.deadline_s = 4: must be at least service_s = 5"),
        "{late}"
    );
}

#[test]
fn a_robot_that_serves_has_a_radio_and_a_pose_and_serves_once() {
    let twice = errors_with(
        &[(SERVE, "[{ kind = \"serve\" }, { kind = \"serve\" }]")],
        "",
    );
    assert_eq!(
        twice,
        [
            "robots.rover.brain.behaviours[1].kind = \"serve\": must be another behaviour: serve is listed before"
        ]
    );
    let radio = (
        "[robots.rover]\nradio = { range_m = 9 }\n",
        "[robots.rover]\n",
    );
    let silent = errors_with(&[radio], "");
    assert!(
        silent.concat().contains("serve needs one, such as radio"),
        "{silent:?}"
    );
    let blind = errors_with(&[("gps = { kind = \"position\" }\n", "")], "").concat();
    assert!(blind.contains("serve needs, for example, gps"), "{blind}");
}
