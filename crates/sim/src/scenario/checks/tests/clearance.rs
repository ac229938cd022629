//! Mined lanes that controllers are to clear, and the tools and sensors that they need.

use super::*;

pub(super) const LANE: &str = r#"
[clock]
step_s = 0.2
time_limit_s = 100

[world]
size_m = [30, 20]

[items.clutter]
count = 2
target = false

[items.mine]
count = 4
number = "poisson"
completed_by = "neutralised"

[robots.oav]
count = 1
layer = "air"
radius_m = 0.1
capabilities = ["survey"]
drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 120 }
radio = { range_m = 50 }
brain = { behaviours = [{ kind = "serve" }] }
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }

[robots.oav.sensors.camera]
kind = "items"
range_m = 5
blind_share = { mine = 0.1 }
confusion = { mine = { mine = 0.8, clutter = 0.2 } }

[robots.ugv]
count = 2
radius_m = 0.5
payload_kg = 5
capabilities = ["search"]
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
radio = { range_m = 50 }
tools = { neutralise = { range_m = 2, duration_s = 5, charges = 3 } }
brain = { behaviours = [{ kind = "serve" }] }
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }

[robots.ugv.sensors.detector]
kind = "items"
range_m = 2
blind_share = { mine = 0.1 }

[controllers.station]
count = 2
radio = { range_m = 50 }
service_lease_s = 30

[controllers.station.clearance]
lane_m = [[4, 4], [24, 16]]
declare_below = 0.1
searches = [{ requires = "survey" }, { requires = "search" }]
interrogate = { requires = "search", service_s = 3 }
neutralise = { requires = "search" }
"#;

const AT: &str = "controllers.station.clearance";

/// The lane with one text replaced by another.
fn with(this: &str, that: &str) -> String {
    assert!(LANE.contains(this), "{this}");
    LANE.replace(this, that)
}

/// The only error of the lane with one text replaced by another.
fn error_with(this: &str, that: &str) -> String {
    let errors = errors_in(&with(this, that));
    assert_eq!(errors.len(), 1, "{that}: {errors:#?}");
    errors.concat()
}

#[test]
fn a_lane_is_read_with_and_without_its_optional_keys() {
    assert_eq!(errors_in(LANE), [""; 0]);
    for optional in [
        "lane_m = [[4, 4], [24, 16]]\n",
        "declare_below = 0.1\n",
        "interrogate = { requires = \"search\", service_s = 3 }\n",
        "neutralise = { requires = \"search\" }\n",
    ] {
        // The floor of the risk is 4%, so that the default of 5% can be reached.
        assert_eq!(errors_in(&with(optional, "")), [""; 0], "{optional}");
    }
}

#[test]
fn all_errors_of_a_lane_are_reported_at_once_with_their_lines() {
    let bad = [
        ("size_m = [30, 20]", "size_m = [30, 20]\nperiodic = true"),
        ("completed_by = \"neutralised\"\n", ""),
        ("{ mine = 0.8, clutter = 0.2 }", "{ mine = 0.8 }"),
        (
            "range_m = 5\nblind_share = { mine = 0.1 }",
            "range_m = 5\nblind_share = { mine = 1.5 }",
        ),
        ("payload_kg = 5\n", ""),
        ("lease_s = 30", "lease_s = 7"),
        ("[24, 16]", "[24, 26]"),
        (
            "declare_below = 0.1",
            "declare_below = 0.1\nexpected_count = { mime = 4, clutter = -1 }",
        ),
        ("{ requires = \"survey\" }", "{ requires = \"sruvey\" }"),
        (
            "interrogate = { requires = \"search\"",
            "interrogate = { requires = \"serch\"",
        ),
        (
            "neutralise = { requires = \"search\"",
            "neutralise = { requires = \"saerch\"",
        ),
    ];
    let text = bad.iter().fold(LANE.to_owned(), |text, (this, that)| {
        assert!(text.contains(this), "{this}");
        text.replace(this, that)
    });
    let text = text
        + "[controllers.other]\ncount = 1\nradio = { range_m = 50 }\n\
           [controllers.other.clearance]\nsearches = []\n";
    let reported = read(&text).unwrap_err().to_string();
    let expected = [
        ("world.periodic", "must be false"),
        ("items.mine.completed_by", "\"neutralised\""),
        (
            "robots.oav.sensors.camera.confusion.mine",
            "they sum to 0.8",
        ),
        ("robots.oav.sensors.camera.blind_share.mine", "from 0 to 1"),
        ("robots.ugv.payload_kg", "a number above 0"),
        ("controllers.station.service_lease_s", "at least 9.4"),
        (&format!("{AT}.lane_m"), "from [0, 0] to [30, 20]"),
        (
            &format!("{AT}.expected_count.mime"),
            "did you mean \"mine\"?",
        ),
        (&format!("{AT}.expected_count.clutter"), "from 0 to 1000000"),
        (
            &format!("{AT}.searches[0].requires"),
            "did you mean \"survey\"?",
        ),
        (
            &format!("{AT}.interrogate.requires"),
            "did you mean \"search\"?",
        ),
        (
            &format!("{AT}.neutralise.requires"),
            "did you mean \"search\"?",
        ),
        (AT, "must be omitted"),
        ("controllers.other.clearance.searches", "at least one way"),
        // They follow from the blind share and the periodic world.
        ("controllers.other.clearance.declare_below", "never falls"),
        (&format!("{AT}.declare_below"), "never falls"),
        ("robots.oav.brain.behaviours[0].kind", "periodic"),
        ("robots.ugv.brain.behaviours[0].kind", "periodic"),
    ];
    for (path, part) in expected {
        let of_path = reported
            .lines()
            .find(|line| line.contains(&format!(": {path} ")));
        let of_path = of_path.unwrap_or_else(|| panic!("{path}\n{reported}"));
        assert!(of_path.contains(part), "{of_path}");
        let line: usize = of_path[2..].split(':').next().unwrap().parse().unwrap();
        let there = text.lines().nth(line - 1).unwrap();
        // A missing key is at its table.
        let key = path.split(['.', '[']).rfind(|part| there.contains(part));
        assert!(key.is_some(), "{there}: {of_path}");
    }
    assert_eq!(reported.lines().count(), expected.len(), "{reported}");
}

#[test]
fn a_risk_below_the_floor_is_refused() {
    // Four mines, of which all sensors are blind to 1%.
    let reported = error_with("declare_below = 0.1", "declare_below = 0.04");
    assert_eq!(
        reported,
        format!(
            "{AT}.declare_below = 0.04: must be at least 0.0412: the sensors are blind to some mines, and the risk \
             never falls below 0.0392"
        )
    );
    assert_eq!(
        errors_in(&with("declare_below = 0.1", "declare_below = 0.0412")),
        [""; 0]
    );
    let by_default = error_with("declare_below = 0.1", "expected_count = { mine = 6 }");
    assert!(
        by_default.starts_with(&format!(
            "{AT}.declare_below = 0.05 (default): must be at least"
        )),
        "{by_default}"
    );
}

#[test]
fn a_lane_is_as_wide_as_the_vehicles_on_the_ground() {
    let reported = error_with("[24, 16]", "[24, 4.9]");
    assert!(
        reported.starts_with(&format!("{AT}.lane_m = "))
            && reported.ends_with("must be a lane at least as wide as robots.ugv, 1 m"),
        "{reported}"
    );
    assert_eq!(errors_in(&with("[24, 16]", "[24, 5]")), [""; 0]);
    // Air vehicles fly over its border.
    let wide = with("radius_m = 0.1", "radius_m = 3").replace("[24, 16]", "[24, 5]");
    assert_eq!(errors_in(&wide), [""; 0]);
}

#[test]
fn corners_of_a_lane_are_in_order_and_finite() {
    for corners in [
        "[[24, 4], [4, 16]]",
        "[[4, 4], [4, 16]]",
        "[[-1, 4], [24, 16]]",
        "[[nan, 4], [24, 16]]",
    ] {
        let reported = error_with("[[4, 4], [24, 16]]", corners);
        assert!(reported.starts_with(&format!("{AT}.lane_m")), "{reported}");
    }
    let cells = error_with("declare_below = 0.1", "declare_below = 0.1\ncell_m = 0.05");
    assert!(cells.starts_with(&format!("{AT}.cell_m = 0.05")), "{cells}");
    let fine = with("size_m = [30, 20]", "size_m = [300, 200]")
        .replace("[[4, 4], [24, 16]]", "[[4, 4], [204, 164]]");
    let fine = errors_in(&fine.replace("declare_below = 0.1", "declare_below = 0.1\ncell_m = 0.5"))
        .concat();
    assert!(fine.contains("at most 65536 cells"), "{fine}");
}

#[test]
fn robots_have_what_the_work_in_a_lane_needs() {
    let none = error_with(
        "searches = [{ requires = \"survey\" }, { requires = \"search\" }]",
        "searches = []",
    );
    assert!(
        none.starts_with(&format!("{AT}.searches = []: must be at least one way")),
        "{none}"
    );
    // Those without a radio or the behaviour do not count.
    let (start, rest) = LANE.split_once("\nradio = { range_m = 50 }").unwrap();
    let silent = format!("{start}{rest}");
    let silent = errors_in(&silent).concat();
    assert!(
        silent.contains(&format!(
            "{AT}.searches[0].requires = \"survey\": must be one of \"search\""
        )),
        "{silent}"
    );
    let without = with(
        "tools = { neutralise = { range_m = 2, duration_s = 5, charges = 3 } }\n",
        "",
    );
    let without = errors_in(&without);
    for path in ["items.mine.completed_by", &format!("{AT}.neutralise")] {
        assert!(
            without.iter().any(|error| error.starts_with(path)),
            "{without:#?}"
        );
    }
    let missing = error_with(
        "requires = \"search\", service_s = 3",
        "requires = \"serach\", service_s = 3",
    );
    assert_eq!(
        missing,
        format!(
            "{AT}.interrogate.requires = \"serach\": must be one of \"search\", \"survey\"; did you mean \"search\"?"
        )
    );
}

#[test]
fn the_lease_outlasts_a_look_and_a_charge() {
    let reported = error_with("lease_s = 30", "lease_s = 8");
    assert!(
        reported.starts_with("controllers.station.service_lease_s = 8: must be at least 9.400")
            && reported.contains("the longest look at a place, 3 s, a charge, 5 s"),
        "{reported}"
    );
}

#[test]
fn a_lane_has_at_most_four_kinds_of_items_and_one_of_mines() {
    let more = |count: usize| {
        let kinds =
            (0..count).map(|kind| format!("[items.scrap{kind}]\ncount = 1\ntarget = false\n"));
        with(
            "[items.clutter]",
            &(kinds.collect::<String>() + "[items.clutter]"),
        )
    };
    assert_eq!(errors_in(&more(2)), [""; 0]);
    let reported = errors_in(&more(3)).concat();
    assert!(
        reported.starts_with("items = ") && reported.contains("at most 4 kinds"),
        "{reported}"
    );
    let none = with(
        "completed_by = \"neutralised\"",
        "target = false\ncompleted_by = \"neutralised\"",
    );
    let none = errors_in(&none).concat();
    assert!(
        none.starts_with("items = ") && none.contains("at least one kind of targets"),
        "{none}"
    );
}

#[test]
fn every_kind_of_targets_is_completed_when_it_is_neutralised() {
    let others = "[items.bomb]\ncount = 1\n[items.shell]\ncount = 1\ncompleted_by = \"confirmed\"\n[items.clutter]";
    let text = with("[items.clutter]", others)
        .replace("tools = { ", "tools = { confirm = { range_m = 2 }, ");
    let reported = errors_in(&text);
    let paths: Vec<&str> = reported
        .iter()
        .filter_map(|error| error.split(' ').next())
        .collect();
    assert_eq!(
        paths,
        ["items.bomb.completed_by", "items.shell.completed_by"],
        "{reported:#?}"
    );
}

#[test]
fn item_detectors_of_a_robot_are_of_one_model_where_they_are_blind() {
    let two =
        "[robots.ugv.sensors.radar]\nkind = \"items\"\nrange_m = 2\n[robots.ugv.sensors.detector]";
    let reported = error_with("[robots.ugv.sensors.detector]", two);
    assert!(
        reported.starts_with("robots.ugv.sensors = ")
            && reported.contains("item detectors of one model"),
        "{reported}"
    );
    let same =
        two.replace("range_m = 2\n", "range_m = 2\nmodel = \"dual\"\n") + "\nmodel = \"dual\"";
    assert_eq!(
        errors_in(&with("[robots.ugv.sensors.detector]", &same)),
        [""; 0]
    );
}

/// The lane with conditions that 99% of missions are to meet.
fn requiring(conditions: &str) -> Vec<String> {
    errors_in(&format!(
        "{LANE}\n[require]\nall = [{conditions}]\nprobability = 0.99\n"
    ))
}

#[test]
fn a_requirement_that_only_clear_lanes_meet_is_not_above_what_looks_achieve() {
    let refused =
        "must be at most 0.961: with probability 0.039, a mine remains that no sensor detects";
    for conditions in [
        "\"declared_clear >= 1\"",
        "\"declared_clear == 1\"",
        "\"declared_clear > 0\"",
        "\"declared_clear != 0\"",
        "\" declared_clear>=0.5\"",
        "\"collisions <= 0\", \"declared_clear > 0.2\"",
        "\"declared >= 1\", \"declared_not_clear == 0\"",
        "\"declared_not_clear < 1\", \"given_up == 0\", \"declared_s < 100\"",
        "\"failed == 0\", \"declared_not_clear <= 0\"",
        "\"time_s <= 90\", \"declared_not_clear <= 0\"",
    ] {
        let reported = requiring(conditions);
        assert_eq!(reported.len(), 1, "{conditions}: {reported:#?}");
        assert!(
            reported[0].starts_with("require.probability = 0.99: ")
                && reported[0].contains(refused),
            "{conditions}: {reported:#?}"
        );
    }
}

/// Controllers declare lanes by what they believe; whether these are clear is up to the sensors.
#[test]
fn what_is_believed_sets_the_risk_of_declarations_and_the_truth_the_requirement() {
    let blind = "blind_share = { mine = 0.1 }";
    let believed = format!("{blind}\nbelieved = {{ blind_share = {{ mine = 0.01 }} }}");
    let text = with("declare_below = 0.1", "declare_below = 0.001").replace(blind, &believed);
    assert_eq!(errors_in(&text), [""; 0]);
    let required = "[require]\nall = [\"declared_clear >= 1\"]\nprobability = 0.99\n";
    let reported = errors_in(&format!("{text}\n{required}"));
    assert_eq!(reported.len(), 1, "{reported:#?}");
    assert!(
        reported[0].contains("must be at most 0.961"),
        "{reported:#?}"
    );
}

#[test]
fn item_detectors_of_a_robot_are_of_one_model_where_items_look_alike_to_them() {
    let alike = "range_m = 2\nlookalike_share = { mine = { clutter = 0.1 } }\nbelieved = { blind_share = { mine = 0 } }";
    let two =
        "[robots.ugv.sensors.radar]\nkind = \"items\"\nrange_m = 2\n[robots.ugv.sensors.detector]";
    let text = with("[robots.ugv.sensors.detector]", two)
        .replace("range_m = 2\nblind", &format!("{alike}\nblind"));
    let reported = errors_in(&text);
    assert_eq!(reported.len(), 1, "{reported:#?}");
    assert!(
        reported[0].contains("item detectors of one model"),
        "{reported:#?}"
    );
}

#[test]
fn a_requirement_that_other_lanes_meet_too_may_have_any_probability() {
    for conditions in [
        "\"declared >= 1\"",
        "\"declared_not_clear == 0\"",
        "\"declared_clear >= 0\"",
        "\"declared_clear != 1\"",
        "\"declared_clear < 1\"",
        "\"declared_s <= 100\", \"declared_not_clear == 0\"",
        "\"given_up == 1\", \"declared_not_clear == 0\"",
        "\"left <= 0\"",
    ] {
        assert_eq!(requiring(conditions), [""; 0], "{conditions}");
    }
}

#[test]
fn cells_are_not_larger_than_what_detectors_see() {
    let reported = error_with("declare_below = 0.1", "declare_below = 0.1\ncell_m = 2.5");
    assert!(
        reported.starts_with(&format!("{AT}.cell_m = 2.5: must be at most 2: "))
            && reported.contains("robots.ugv.sensors.detector sees no farther than 2 m"),
        "{reported}"
    );
    let fine = with("declare_below = 0.1", "declare_below = 0.1\ncell_m = 2");
    assert_eq!(errors_in(&fine), [""; 0]);
}

#[test]
fn sensors_and_tools_reach_mines_from_where_these_destroy_no_robot() {
    let mines = "completed_by = \"neutralised\"\nhazard = { radius_m = 0.3 }";
    let dangerous =
        |this: &str, that: &str| with("completed_by = \"neutralised\"", mines).replace(this, that);
    assert_eq!(errors_in(&dangerous("", "")), [""; 0]);
    for (path, this) in [
        ("tools.neutralise", "neutralise = { range_m = 2"),
        ("sensors.detector", "kind = \"items\"\nrange_m = 2"),
    ] {
        let short = this.replace("range_m = 2", "range_m = 1");
        let text = dangerous(this, &short);
        let reported = errors_in(&text);
        assert_eq!(
            reported,
            [format!(
                "robots.ugv.{path}.range_m = 1: must be above 1.000: from farther away only, mine, which is a danger within \
                 0.3 m, cannot destroy the robot, which has a radius of 0.5 m"
            )]
        );
        // Items that destroy nothing are no reason.
        let harmless = text.replace(
            "radius_m = 0.3 }",
            "radius_m = 0.3, destroy_probability = 0 }",
        );
        assert_eq!(errors_in(&harmless), [""; 0]);
    }
}

#[test]
fn items_look_alike_to_all_sensors_of_a_model() {
    let alike = |share: &str| {
        format!(
            "range_m = 2\nmodel = \"em\"\nlookalike_share = {{ mine = {{ clutter = {share} }} }}\nblind"
        )
    };
    let radar = |share: &str| {
        let table = alike(share).replace("\nblind", "");
        let two = format!(
            "[robots.ugv.sensors.radar]\nkind = \"items\"\n{table}\n[robots.ugv.sensors.detector]"
        );
        let text = with("[robots.ugv.sensors.detector]", &two);
        errors_in(&text.replace("range_m = 2\nblind", &alike("0.1")))
    };
    assert_eq!(radar("0.1"), [""; 0]);
    let reported = radar("0.2");
    assert_eq!(reported.len(), 1, "{reported:#?}");
    let expected = "lookalike_share = {...}: must be as in robots.ugv.sensors.detector, which is of the same model";
    assert!(reported[0].contains(expected), "{reported:#?}");
}
