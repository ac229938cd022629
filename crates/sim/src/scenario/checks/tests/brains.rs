use super::*;

#[test]
fn beliefs_require_a_bounded_world() {
    let drive = "drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }\n";
    let world = "size_m = [20, 10]\n";
    let text = GOOD
        .replace(drive, &format!("{drive}brain = {{ beliefs = {{}} }}\n"))
        .replace(world, &format!("{world}periodic = true\n"));
    let reported = read(&text).unwrap_err().to_string();
    assert!(
        reported.contains("robots.rover.brain.beliefs = ")
            && reported.contains("need periodic = false"),
        "{reported}"
    );
}

/// The errors of the good scenario whose bird, which has no sensors, has this brain.
fn errors_of_brain(brain: &str) -> Vec<String> {
    let drive = "drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }";
    errors(drive, &format!("{drive}\nbrain = {{ {brain} }}"))
}

#[test]
fn behaviours_need_sensors_and_places() {
    let reported = errors_of_brain("behaviours = [{ kind = \"correct\" }]");
    let at = "robots.bird.brain.behaviours[0]";
    let needs = |what: &str| {
        format!(
            "{at}.kind = \"correct\": must be a behaviour whose sensors the robot has: correct needs, for \
             example, {what} under its sensors"
        )
    };
    let expected = [
        needs("gps = { kind = \"position\" }"),
        needs("compass = { kind = \"heading\" }"),
        format!(
            "{at}.waypoints_m is missing: expected the places to visit, at least one, as in [[5, 5], [9, 2.5]]"
        ),
    ];
    assert_eq!(reported, expected);
}

#[test]
fn a_robot_that_stands_when_nothing_is_left_may_wait_for_orders_without_waypoints() {
    let drive = "drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }";
    let is_accepted = |more: &str| {
        let more = format!(
            "{drive}\nsensors = {{ gps = {{ kind = \"position\" }}, compass = {{ kind = \"heading\" }} }}\n\
             brain = {{ behaviours = [{{ kind = \"correct\"{more} }}] }}"
        );
        read(&GOOD.replace(drive, &more)).is_ok()
    };
    assert!(is_accepted(", stop_when_done = true"));
    assert!(!is_accepted(""));
}

#[test]
fn behaviours_with_others_need_to_know_of_them_and_sweeps_how_wide_they_see() {
    let reported = errors_of_brain(
        "behaviours = [{ kind = \"follow\" }, { kind = \"flock\" }, { kind = \"lawnmower\" }, \
         { kind = \"spiral\" }, { kind = \"navigate\", assignment = \"shared\", waypoints_m = [[1, 1]] }]",
    );
    let behaviour = |number: u32| format!("robots.bird.brain.behaviours[{number}]");
    let lacks = |number, key: &str, what: &str| {
        let path = format!("{}.{key} = ", behaviour(number));
        reported
            .iter()
            .any(|error| error.starts_with(&path) && error.contains(what))
    };
    for (number, key, what) in [
        (0, "kind", "kind = \"robots\""),
        (1, "kind", "kind = \"robots\""),
        (2, "kind", "kind = \"items\""),
        (3, "kind", "kind = \"items\""),
        (4, "assignment", "needs a radio"),
    ] {
        assert!(lacks(number, key, what), "{number}: {reported:?}");
    }
    let reported = errors_of_brain(
        "behaviours = [{ kind = \"lawnmower\", width_m = 2 }, { kind = \"spiral\", width_m = 2 }]",
    );
    assert!(
        !reported.iter().any(|error| error.contains("items")),
        "{reported:?}"
    );
}

#[test]
fn places_lie_in_the_world() {
    let reported = errors_of_brain(
        "behaviours = [{ kind = \"navigate\", waypoints_m = [[2, 2], [21, 2]] }, \
         { kind = \"return_home\", at_m = [-1, 2] }, { kind = \"spiral\", around_m = [3, 11], width_m = 1 }]",
    );
    let outside: Vec<&String> = reported
        .iter()
        .filter(|error| error.contains("within"))
        .collect();
    let at = "robots.bird.brain.behaviours";
    let expected = [
        format!(
            "{at}[0].waypoints_m[1] = [21, 2]: must be within the world: from [0, 0] to [20, 10]"
        ),
        format!("{at}[1].at_m = [-1, 2]: must be within the world: from [0, 0] to [20, 10]"),
        format!("{at}[2].around_m = [3, 11]: must be within the world: from [0, 0] to [20, 10]"),
    ];
    assert_eq!(outside, expected.iter().collect::<Vec<_>>(), "{reported:?}");
}

#[test]
fn gains_are_those_of_its_behaviours() {
    let brain = |gains: &str| {
        format!(
            "arbitration = {{ kind = \"schemas\", gains = {{ {gains} }} }}, \
             behaviours = [{{ kind = \"cruise\" }}, {{ kind = \"avoid\" }}]"
        )
    };
    let at = "robots.bird.brain.arbitration.gains";
    assert_eq!(
        errors_of_brain(&brain("cruse = 2, avoid = -1")),
        [
            format!("{at}.avoid = -1: must be a number from 0 to 1000000"),
            format!(
                "{at}.cruse is not a known key: expected one of cruise, avoid; did you mean cruise?"
            ),
        ]
    );
    let slip = brain("").replace("gains", "gain");
    let reported = errors_of_brain(&slip).concat();
    assert!(
        reported.contains("is not a known key: expected one of kind, gains, influence_m"),
        "{reported}"
    );
}
