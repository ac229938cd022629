use super::super::{Checked, ScenarioSpec};
use base::document::Document;
use base::error::InputErrors;

mod brains;
mod clearance;
mod controllers;
mod drive;
mod end;
mod goals;
mod identification;
mod obstacles;
mod passage;
mod periodic;
mod renamed;

const GOOD: &str = r#"
[clock]
step_s = 0.1
time_limit_s = 120

[world]
size_m = [20, 10]
obstacles = [
    { polygon_m = [[0, 0], [4, 0], [4, 4], [0, 4]] },
    { circle = { at_m = [15, 5], radius_m = 1 } },
]

[terrain.mud]
areas_m = [[[10, 0], [20, 0], [20, 10]]]

[items.mine]
count = 2
placement = { kind = "fixed", at_m = [[5, 5], [19, 9]] }

[robots.rover]
count = 2
radius_m = 0.5
start = { kind = "fixed", at_m = [[6, 6], [7, 6]], heading_deg = [0, 90] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }

[robots.rover.sensors.eye]
kind = "items"
range_m = 3
detection_probability = { mine = [[0, 1], [3, 0.5]] }
false_alarm_rate_per_m2_s = { mine = 0.01 }

[robots.bird]
count = 1
radius_m = 0.3
layer = "air"
drive = { max_speed_m_s = 5, max_turn_rate_deg_s = 90 }
"#;

fn read(text: &str) -> Result<Checked, InputErrors> {
    let document = Document::parse("t", text).unwrap();
    ScenarioSpec::read(&document)
}

/// The errors of the valid scenario with one text replaced by another, without their lines.
fn errors(this: &str, that: &str) -> Vec<String> {
    assert!(GOOD.contains(this), "{this}");
    let errors = errors_in(&GOOD.replace(this, that));
    assert!(!errors.is_empty(), "{that}");
    errors
}

/// The errors of a scenario, without their lines.
fn errors_in(text: &str) -> Vec<String> {
    let errors = read(text).err().map_or_else(Vec::new, |errors| errors.0);
    let reported = errors.iter().map(ToString::to_string);
    reported
        .map(|error| {
            let (origin, rest) = error.split_once(": ").unwrap();
            assert!(origin.starts_with("t:"), "{error}");
            rest.to_owned()
        })
        .collect()
}

fn error(this: &str, that: &str) -> String {
    let errors = errors(this, that);
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.concat()
}

#[test]
fn a_good_scenario_is_read() {
    let Checked { spec, scenario } = read(GOOD).unwrap();
    assert_eq!(scenario.robots(), 3);
    assert_eq!(spec.robots.keys().collect::<Vec<_>>(), ["bird", "rover"]);
}

#[test]
fn the_place_on_the_earth_is_optional_and_checked_as_a_whole() {
    assert_eq!(read(GOOD).unwrap().spec.world.origin, None);
    let zurich = "[world.origin]\nlatitude_deg = 47.4\nlongitude_deg = 8.5\nrotation_deg = 30";
    let spec = read(&format!("{GOOD}\n{zurich}")).unwrap().spec;
    let origin = spec.world.origin.unwrap();
    assert_eq!((origin.latitude_deg, origin.longitude_deg), (47.4, 8.5));
    assert_eq!((origin.rotation_deg, origin.declination_deg), (30.0, 0.0));
    let bad = "[world.origin]\nlatitude_deg = 91\nlongtude_deg = 8.5\nrotation_deg = inf";
    let errors = read(&format!("{GOOD}\n{bad}")).unwrap_err().to_string();
    for part in [
        "world.origin.latitude_deg = 91: must be a number from -85 to 85 (degrees)",
        "did you mean longitude_deg?",
        "world.origin.longitude_deg is missing",
        "world.origin.rotation_deg = inf: must be a number from -360 to 360 (degrees)",
    ] {
        assert!(errors.contains(part), "{errors}");
    }
}

#[test]
fn keys_that_are_not_the_engines_are_left_to_others() {
    assert!(read(&format!("merit = 3\nstudy = 4\nx = 5\n{GOOD}")).is_ok());
}

#[test]
fn errors_of_every_part_are_reported_at_once_with_their_lines() {
    let bad = GOOD
        .replace("time_limit_s = 120", "time_limit_s = 1e7\n")
        .replace("0.1\n", "0.01\n")
        .replace("[4, 4]", "[-1, 2]")
        .replace(
            "detection_probability = { mine",
            "detection_probability = { mien",
        );
    let reported = read(&bad).unwrap_err().to_string();
    let expected = "t:4: clock.time_limit_s = 10000000.0: must be at most 1000000: a run has at most \
                    100000000 steps, here of 0.01 s\n\
                    t:30: robots.rover.sensors.eye.detection_probability.mien is not a known key: \
                    expected one of mine; did you mean mine?\n\
                    t:10: world.obstacles[0].polygon_m = [[0, 0], [4, 0], [-1, 2], [0, 4]]: must be a \
                    polygon that does not intersect itself; the edges from vertices 1 and 3 do";
    assert_eq!(reported, expected);
}

#[test]
fn errors_of_types_are_reported_before_errors_of_combinations() {
    assert_eq!(
        errors("radius_m = 0.5", "radius_m = nan"),
        ["robots.rover.radius_m = NaN: must be a number from 0 to 100 (metres)"]
    );
}

#[test]
fn names_can_stand_in_a_column_and_a_path() {
    let long = "x".repeat(65);
    for name in ["\"a b\"", "\"\"", "\"a.b\"", "\"ä\"", &long] {
        let reported = error("[robots.bird]", &format!("[robots.{name}]"));
        assert!(reported.ends_with(
            "must be under a name of at most 64 letters a to z or A to Z, digits, _ and -"
        ));
    }
    assert!(error("[terrain.mud]", "[terrain.\"m d\"]").starts_with("terrain.\"m d\" = {...}"));
    assert!(
        error("sensors.eye]", "sensors.\"\"]").starts_with("robots.rover.sensors.\"\" = {...}")
    );
}

#[test]
fn two_kinds_never_have_the_same_random_numbers() {
    // Words with the same FNV-1a hash.
    for what in ["items", "robots"] {
        let rest = if what == "items" {
            "count = 0"
        } else {
            "model = \"ugv\"\ncount = 0"
        };
        let kind = |name: &str| format!("\n[{what}.{name}]\n{rest}\n");
        let both = kind("costarring") + &kind("liquid");
        let reported = read(&format!("{GOOD}{both}")).unwrap_err().to_string();
        assert!(
            reported.contains(&format!(
                "{what}.liquid = {{...}}: must be a different name: the hash that keys its random \
                 numbers equals that of costarring"
            )),
            "{reported}"
        );
        assert!(read(&format!("{GOOD}{}", kind("liquid"))).is_ok());
    }
}

#[test]
fn no_kind_of_items_has_the_column_of_a_time_of_another() {
    assert_eq!(
        error(
            "[terrain.mud]",
            "[items.mine_2_s]\ncount = 0\n[terrain.mud]"
        ),
        "items.mine_2_s = {...}: must be a different name: found_mine_2_s is the time of a find of mine"
    );
    for name in ["mine_s", "mine_x_s", "cow_2_s", "2_s"] {
        let items = format!("[items.{name}]\ncount = 0\n[terrain.mud]");
        assert!(
            read(&GOOD.replace("[terrain.mud]", &items)).is_ok(),
            "{name}"
        );
    }
}

#[test]
fn there_are_one_to_255_kinds_of_robots() {
    let start = GOOD.find("[robots.rover]").unwrap();
    let none = format!("{}[robots]", &GOOD[..start]);
    assert_eq!(
        read(&none).unwrap_err().to_string(),
        "t:20: robots = {...}: must be a table of 1 to 255; it has 0"
    );
    let many = (0..256).map(|kind| format!("[robots.r{kind}]\nmodel = \"ugv\"\ncount = 0\n"));
    let many = many.collect::<Vec<_>>().concat();
    let reported = read(&format!("{}{many}", &GOOD[..start])).unwrap_err();
    assert!(reported.to_string().contains("it has 256"), "{reported}");
}

#[test]
fn rates_are_at_most_one_a_step() {
    assert_eq!(
        error("range_m = 3", "range_m = 3\nrate_hz = 10.1"),
        "robots.rover.sensors.eye.rate_hz = 10.1: must be at most 10, once per step of 0.1 s"
    );
    assert!(read(&GOOD.replace("range_m = 3", "range_m = 3\nrate_hz = 10")).is_ok());
    let brain = "radius_m = 0.3\nbrain = { rate_hz = 20 }";
    assert!(error("radius_m = 0.3", brain).starts_with("robots.bird.brain.rate_hz = 20: must be"));
}

#[test]
fn a_step_is_short_enough_for_what_moves() {
    assert_eq!(
        errors("step_s = 0.1", "step_s = 3"),
        [
            "robots.bird.drive.max_speed_m_s = 5: must be at most 3.3333333333333335, at which it \
             crosses the world in one step of 3 s",
            "robots.bird.drive.max_turn_rate_deg_s = 90: must be at most 60, half a turn in one step of \
             3 s",
            "robots.rover.drive.max_turn_rate_deg_s = 90: must be at most 60, half a turn in one step \
             of 3 s",
        ]
    );
}

#[test]
fn a_detection_table_ascends_and_has_probabilities() {
    for table in [
        "[]",
        "[[0, 1.1]]",
        "[[-1, 1]]",
        "[[1, 1], [1, 0]]",
        "[[2, 1], [1, 0]]",
    ] {
        let reported = error("[[0, 1], [3, 0.5]]", table);
        assert!(
            reported.contains("must be at least one pair of a distance"),
            "{reported}"
        );
    }
    let reported = error("mine = 0.01", "mine = -1");
    assert!(
        reported.ends_with("false_alarm_rate_per_m2_s.mine = -1: must be a number from 0 to 1000")
    );
    assert_eq!(
        error("mine = 0.01", "cow = 1"),
        "robots.rover.sensors.eye.false_alarm_rate_per_m2_s.cow is not a known key: expected one of mine"
    );
}

#[test]
fn the_false_alarms_of_a_measurement_are_bounded() {
    // A circle of 3 m for 0.1 s.
    let reported = error("mine = 0.01", "mine = 200");
    let end = "must be lower, so that a measurement has at most 500 false alarms; in its whole range and \
               0.1 s it has 565";
    assert!(reported.ends_with(end), "{reported}");
    assert!(read(&GOOD.replace("mine = 0.01", "mine = 150")).is_ok());
    let slow = GOOD.replace("range_m = 3", "range_m = 3\nrate_hz = 0.01");
    assert!(read(&slow).is_ok());
    assert!(error("mine = 0.01 }", "mine = 1 }\nrate_hz = 0.01").contains("and 100 s it has 2827"));
}

#[test]
fn a_robot_has_at_most_32_sensors() {
    let sensors = |count: u32| -> String {
        let sensor = |number| format!("[robots.rover.sensors.c{number}]\nkind = \"heading\"\n");
        (0..count).map(sensor).collect()
    };
    let with = |count| format!("{}[robots.bird]", sensors(count));
    assert!(read(&GOOD.replace("[robots.bird]", &with(31))).is_ok());
    let reported = error("[robots.bird]", &with(32));
    assert!(
        reported.ends_with("must be a table of 0 to 32; it has 33"),
        "{reported}"
    );
}

#[test]
fn a_battery_that_is_never_full_is_none() {
    let reported = error(
        "count = 1\nradius_m = 0.3",
        "count = 1\nbattery = { capacity_j = 0 }\nradius_m = 0.3",
    );
    assert!(
        reported.starts_with("robots.bird.battery.capacity_j = 0: must be"),
        "{reported}"
    );
}

#[test]
fn invalid_obstacles_and_positions_are_reported_at_once() {
    let text = GOOD
        .replace("[15, 5]", "[150, 5]")
        .replace("[19, 9]", "[190, 9]");
    let errors = read(&text).unwrap_err().0;
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(
        paths,
        ["world.obstacles[1]", "items.mine.placement.at_m[1]"]
    );
}

#[test]
fn an_obstacle_is_at_least_partly_in_the_world() {
    assert_eq!(
        error("[15, 5]", "[15, -2]"),
        "world.obstacles[1] = {...}: must be at least partly in the world, from [0, 0] to [20, 10]"
    );
    assert!(read(&GOOD.replace("[15, 5]", "[15, -0.5]")).is_ok());
}

#[test]
fn an_area_has_an_inside() {
    let reported = error("[[[10, 0], [20, 0], [20, 10]]]", "[[[10, 0], [20, 0]]]");
    assert!(reported.starts_with("terrain.mud.areas_m[0] = [[10, 0], [20, 0]]: must be a polygon"));
}

#[test]
fn given_places_are_enough_and_free() {
    let of_items = |places: &str| error("[[5, 5], [19, 9]]", places);
    assert_eq!(
        of_items("[[5, 5]]"),
        "items.mine.placement.at_m = [[5, 5]]: must be a list of at least 2 places, the count; it has \
         1"
    );
    let free = "must be in the world, from [0, 0] to [20, 10], and not in an obstacle";
    assert_eq!(
        of_items("[[5, 5], [20.1, 9]]"),
        format!("items.mine.placement.at_m[1] = [20.1, 9]: {free}")
    );
    assert_eq!(
        of_items("[[4, 1], [19, 9]]"),
        format!("items.mine.placement.at_m[0] = [4, 1]: {free}")
    );
    assert_eq!(
        error("[[6, 6], [7, 6]]", "[[6, 6], [4.4, 1]]"),
        "robots.rover.start.at_m[1] = [4.4, 1]: must be in the world, from [0, 0] to [20, 10], at \
         least radius_m = 0.5 from its border and from any obstacle"
    );
    assert!(read(&GOOD.replace("[7, 6]", "[4.5, 1]")).is_ok());
    assert!(
        read(
            &GOOD
                .replace("[[6, 6], [7, 6]]", "[[6, 6], [7, 6], [0, 0]]")
                .replace("[0, 90]", "[0, 90, 0]")
        )
        .is_ok()
    );
}

#[test]
fn each_given_place_has_a_heading_or_none_has() {
    assert_eq!(
        error("[0, 90]", "[0]"),
        "robots.rover.start.heading_deg = [0]: must be a list of 2 headings, one for each place"
    );
}

#[test]
fn robots_of_a_layer_do_not_stand_in_each_other() {
    assert_eq!(
        error("[[6, 6], [7, 6]]", "[[6, 6], [6.9, 6]]"),
        "robots.rover.start.at_m[1] = [6.9, 6]: must be at least 1 from the robot at [6, 6]"
    );
    let bird = "layer = \"air\"\nstart = { kind = \"fixed\", at_m = [[6, 6]] }";
    assert!(read(&GOOD.replace("layer = \"air\"", bird)).is_ok());
    let reported = error("layer = \"air\"", &bird.replace("air", "ground"));
    assert!(
        reported.contains("at least 0.8 from the robot at"),
        "{reported}"
    );
}

#[test]
fn robots_that_start_anywhere_have_room() {
    let bird = |count: &str, radius: &str| {
        error(
            "count = 1\nradius_m = 0.3",
            &format!("count = {count}\nradius_m = {radius}"),
        )
    };
    let reported = bird("1", "5.1");
    assert_eq!(
        reported,
        "robots.bird.count = 1: must be 0: none of 16384 examined start places is free for \
         radius_m = 5.1"
    );
    let reported = bird("400", "0.3");
    assert!(reported.starts_with("robots.bird.count = 400: must be fewer: randomly placed robots"));
    assert!(
        reported.contains("50 % of the 200 m2 of free area, but all air robots would cover 113 m2")
    );
}

#[test]
fn items_that_are_anywhere_have_room() {
    let anywhere = "placement = { kind = \"uniform\", within_m = [[1, 1], [3, 3]] }";
    let fixed = "placement = { kind = \"fixed\", at_m = [[5, 5], [19, 9]] }";
    assert_eq!(
        error(fixed, anywhere),
        "items.mine.count = 2: must be 0: their area has no free place"
    );
    let reported = error(fixed, &anywhere.replace("[3, 3]", "[3, 13]"));
    assert!(
        reported.contains("within_m = [[1, 1], [3, 13]]: must be two corners in the world, from")
    );
}

#[test]
fn a_run_fits_into_memory() {
    let rays = "count = 1000000\nsensors = { a = { kind = \"range\", rays = 1440, range_m = 1 } }";
    let reported = error(
        "count = 1\nradius_m = 0.3",
        &format!("{rays}\nradius_m = 0"),
    );
    assert_eq!(
        reported,
        "robots.bird.count = 1000000: must be fewer, or with fewer rays, contacts and messages: a run \
         may take 4 GB of memory, and this one takes about 13.5 GB, 13.5 GB for these"
    );
}

#[test]
fn points_can_be_many_in_a_small_place() {
    let many = "count = 100000\nradius_m = 0";
    assert!(read(&GOOD.replace("count = 1\nradius_m = 0.3", many)).is_ok());
}

/// A map of 2 m by 1 m whose left half is occupied, in a folder beside the scenario.
fn open(file: &str) -> Result<Vec<u8>, String> {
    let yaml = "image: room.pgm\nresolution: 1\norigin: [8, 4, 0]\nnegate: 0\n\
                occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    match file {
        "maps/room.yaml" => Ok(yaml.into()),
        "maps/bad.yaml" => Ok(yaml.replace("resolution: 1", "resolution: -1").into()),
        "maps/room.pgm" => Ok("P2 2 1 255  0 254".into()),
        _ => Err(format!("there is no {file}")),
    }
}

fn read_with_map(map: &str, start: &str) -> Result<Checked, String> {
    let map = format!("{{ map = {map:?} }}");
    let text = GOOD.replace("{ circle = { at_m = [15, 5], radius_m = 1 } }", &map);
    let document = Document::parse("t", &text.replace("[7, 6]", start)).unwrap();
    ScenarioSpec::read_with(&document, open).map_err(|errors| errors.to_string())
}

#[test]
fn a_map_is_read_and_is_in_the_way() {
    assert!(read_with_map("maps/room.yaml", "[9.5, 4.5]").is_ok());
    for (start, is_free) in [
        ("[8.5, 4.5]", false),
        ("[9.4, 4.5]", false),
        ("[7.4, 4.5]", true),
    ] {
        let reported = read_with_map("maps/room.yaml", start).err();
        let expected = format!("t:23: robots.rover.start.at_m[1] = {start}: must be in the world");
        assert_eq!(reported.is_none(), is_free, "{start}");
        assert!(
            reported.is_none_or(|reported| reported.starts_with(&expected)),
            "{start}"
        );
    }
}

#[test]
fn a_missing_or_invalid_map_is_an_error() {
    assert_eq!(
        read_with_map("room.yaml", "[7, 6]").unwrap_err(),
        "t:10: world.obstacles[1].map = \"room.yaml\": must be a file that can be read: there is no \
         room.yaml"
    );
    let reported = read_with_map("maps/bad.yaml", "[7, 6]").unwrap_err();
    assert!(
        reported.starts_with("maps/bad.yaml:2: resolution = -1: must be"),
        "{reported}"
    );
}

#[test]
fn some_robot_must_be_able_to_detect_the_targets() {
    let clutter = "[items.cow]\ncount = 1\n[items.mine]";
    assert_eq!(
        error("[items.mine]", clutter),
        "items.cow = {...}: must be a kind of item that a robot can detect: none has a sensor of kind \"items\" for it; for \
         clutter, set target = false"
    );
    assert!(
        read(&GOOD.replace(
            "[items.mine]",
            &clutter.replace("1\n", "1\ntarget = false\n")
        ))
        .is_ok()
    );
}

#[test]
fn a_given_place_behind_walls_is_out_of_reach() {
    let wall = "{ polygon_m = [[13, 0], [13.5, 0], [13.5, 10], [13, 10]] },\n{ circle";
    assert_eq!(
        error("{ circle", wall),
        "items.mine.placement.at_m[1] = [19, 9]: must be a place that a robot with a sensor for it can reach \
         within range"
    );
    let gap = wall.replace("[13.5, 10], [13, 10]", "[13.5, 8.9], [13, 8.9]");
    assert!(read(&GOOD.replace("{ circle", &gap)).is_ok());
}

/// The valid scenario with a ring of walls, the last of which ends here, with mines inside, and a
/// camera that does not see through it.
fn ring(last_to: f64, placement: &str) -> String {
    let wall = |low: [f64; 2], high: [f64; 2]| {
        let ([left, bottom], [right, top]) = (low, high);
        format!(
            "{{ polygon_m = [[{left}, {bottom}], [{right}, {bottom}], [{right}, {top}], \
             [{left}, {top}]] }},\n"
        )
    };
    let walls = [
        wall([8.0, 1.0], [14.0, 2.0]),
        wall([8.0, 6.0], [14.0, 7.0]),
        wall([13.0, 1.5], [14.0, 6.5]),
        wall([8.0, 1.5], [9.0, last_to]),
    ];
    let pillar = "    { circle = { at_m = [15, 5], radius_m = 1 } },\n";
    assert!(GOOD.contains(pillar));
    GOOD.replace(pillar, &walls.concat())
        .replace("range_m = 3", "range_m = 0.5")
        .replace("[[0, 1], [3, 0.5]]", "1")
        .replace(r#"{ kind = "fixed", at_m = [[5, 5], [19, 9]] }"#, placement)
}

#[test]
fn items_anywhere_in_a_closed_ring_are_out_of_reach() {
    let hollow = "within_m = [[9.5, 2.5], [12.5, 5.5]]";
    for placement in [
        format!(r#"{{ kind = "uniform", {hollow} }}"#),
        format!(r#"{{ kind = "clustered", clusters = 1, spread_m = 1, {hollow} }}"#),
    ] {
        let errors = read(&ring(6.5, &placement)).unwrap_err().0;
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert_eq!(errors[0].path, "items.mine.placement.within_m");
        assert!(errors[0].to_string().contains("can reach within range"));
        // With a gap, or a robot that starts inside, or that sees or flies over the walls, they can
        // be reached.
        assert!(read(&ring(4.8, &placement)).is_ok());
        let closed = ring(6.5, &placement);
        for (this, that) in [
            ("[[6, 6], [7, 6]]", "[[6, 6], [11, 4]]"),
            ("range_m = 0.5", "range_m = 2.5"),
            ("radius_m = 0.5\n", "radius_m = 0.5\nlayer = \"air\"\n"),
        ] {
            assert!(closed.contains(this), "{this}");
            assert!(read(&closed.replace(this, that)).is_ok(), "{that}");
        }
    }
    let somewhere = r#"{ kind = "uniform" }"#;
    assert!(read(&ring(6.5, somewhere)).is_ok());
}

/// The walls of a ring and a world with the maximum number of cells.
#[test]
fn looking_for_a_place_in_reach_is_done_within_seconds() {
    let text = ring(
        6.5,
        r#"{ kind = "uniform", within_m = [[9.5, 2.5], [12.5, 5.5]] }"#,
    );
    let fine = text
        .replace("radius_m = 0.5\n", "radius_m = 0.02\n")
        .replace("range_m = 0.5", "range_m = 0.9");
    let begin = std::time::Instant::now();
    assert_eq!(read(&fine).unwrap_err().0.len(), 1);
    assert!(begin.elapsed() < std::time::Duration::from_secs(10));
}
