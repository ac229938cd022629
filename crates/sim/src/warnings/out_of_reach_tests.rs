use super::*;

/// Two rooms of 10 m by 20 m with a wall between them, and robots that start in the left one.
const ROOMS: &str = r#"
clock = { time_limit_s = 60 }
world = { size_m = [20, 20], obstacles = [{ rectangle = { at_m = [10, 10], size_m = [0.2, 20] } }] }

[items.mine]
count = 4
target = true
placement = { kind = "uniform" }

[robots.rover]
count = 2
radius_m = 0.3
start = { kind = "uniform", within_m = [[1, 1], [8, 19]] }
drive = { max_speed_m_s = 0.5 }
sensors = { camera = { kind = "items", range_m = 0.5, needs_line_of_sight = true } }
"#;

const LEFT: &str = "{ kind = \"uniform\", within_m = [[1, 1], [8, 19]] }";
const WALL: &str = "{ rectangle = { at_m = [10, 10], size_m = [0.2, 20] } }";

/// The wall with a gap of 0.9 m.
const DOOR: &str = "{ rectangle = { at_m = [10, 4.75], size_m = [0.2, 9.5] } }, \
                    { rectangle = { at_m = [10, 15.2], size_m = [0.2, 9.6] } }";

/// A closed hall of 5 m by 5 m in the upper right corner.
const HALL: &str = "{ rectangle = { at_m = [15, 17.5], size_m = [0.2, 5] } }, \
                    { rectangle = { at_m = [17.5, 15], size_m = [5, 0.2] } }";

fn warnings_of(changes: &[(&str, &str)]) -> Vec<String> {
    let mut text = ROOMS.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let document = Document::parse("t.toml", &text).unwrap();
    ScenarioSpec::read(&document).unwrap();
    let found = warnings(&document, &[Vec::new()]);
    let found = found.iter().map(ToString::to_string);
    found.filter(|each| each.contains("can reach")).collect()
}

fn is_warned(changes: &[(&str, &str)], words: &str) -> bool {
    let found = warnings_of(changes);
    found.len() == 1 && found[0].contains(words)
}

#[test]
fn a_room_without_a_door_is_reported_with_its_share_and_place_and_what_to_do() {
    assert_eq!(
        warnings_of(&[]),
        [
            "t.toml:8: items.mine.placement = {...}: no robot with a sensor for it can reach 50.0% of its free area, \
             near [14.9, 9.9], within range: about 94% of runs have one there; limit the area with within_m, make a \
             way wider than 0.6 m, or start a robot there"
        ]
    );
}

#[test]
fn a_door_counts_for_the_robots_that_fit_through_it() {
    let large = ("radius_m = 0.3", "radius_m = 0.7");
    assert!(warnings_of(&[(WALL, DOOR)]).is_empty());
    assert!(is_warned(&[(WALL, DOOR), large], "50.1% of its free area"));
    let small = "\n[robots.small]\ncount = 1\nradius_m = 0.2\nstart = { kind = \"fixed\", at_m = [[2, 2]] }\n\
                 drive = { max_speed_m_s = 0.5 }\nsensors = { camera = { kind = \"items\", range_m = 0.5 } }\n";
    let both = [
        (WALL, DOOR),
        large,
        ("\n[robots.rover]", &format!("{small}\n[robots.rover]")),
    ];
    assert!(warnings_of(&both).is_empty());
    // Robots that are not sent find nothing.
    assert!(is_warned(
        &[&both[..], &[("count = 1\n", "count = 0\n")]].concat(),
        "50.1%"
    ));
}

#[test]
fn robots_in_the_air_reach_every_room() {
    assert!(warnings_of(&[("count = 2", "count = 2\nlayer = \"air\"")]).is_empty());
}

#[test]
fn only_given_starts_of_the_robots_that_are_sent_count() {
    let both = "{ kind = \"fixed\", at_m = [[2, 2], [18, 18]] }";
    assert!(warnings_of(&[(LEFT, both)]).is_empty());
    assert!(is_warned(
        &[(LEFT, both), ("count = 2", "count = 1")],
        "50.0%"
    ));
}

#[test]
fn robots_that_start_at_random_in_two_rooms_miss_what_is_where_none_starts() {
    // In each room, with the chance that both robots start in the other one.
    let words = "in a run, on average, no robot with a sensor for it can reach 25.0% of its free area within range";
    assert!(is_warned(&[(LEFT, "{ kind = \"uniform\" }")], words));
    let many = [
        (LEFT, "{ kind = \"uniform\" }"),
        ("count = 2", "count = 20"),
    ];
    assert!(warnings_of(&many).is_empty());
}

#[test]
fn the_smallest_team_that_is_compared_decides_what_is_missed_and_is_named() {
    let path = "robots.rover.count".to_owned();
    let sizes = |counts: &[i64]| -> Vec<Vec<(String, Value)>> {
        let each = counts.iter();
        each.map(|count| vec![(path.clone(), Value::Integer(*count))])
            .collect()
    };
    let text = ROOMS.replace(LEFT, "{ kind = \"uniform\" }");
    let of = |text: &str, counts: &[i64]| {
        let document = Document::parse("t.toml", text).unwrap();
        let found = warnings(&document, &sizes(counts));
        let found = found.iter().map(ToString::to_string);
        let found: Vec<String> = found.filter(|each| each.contains("can reach")).collect();
        found
    };
    let found = of(&text, &[0, 1, 20]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("with robots.rover.count = 1: in a run, on average"));
    assert!(
        found[0].contains("can reach 50.0% of its free area"),
        "{found:?}"
    );
    // A room that no number of robots reaches has one warning, of no team.
    let found = of(ROOMS, &[0, 1, 20]);
    assert_eq!(found, warnings_of(&[]));
}

#[test]
fn a_range_does_not_reach_through_walls_unless_the_sensor_does() {
    let far = ("range_m = 0.5", "range_m = 8");
    assert!(is_warned(
        &[(WALL, HALL), far],
        "5.9% of its free area, near [17.4, 17.4]"
    ));
    let through = ("needs_line_of_sight = true", "needs_line_of_sight = false");
    assert!(warnings_of(&[(WALL, HALL), far, through]).is_empty());
    // A gap that is too narrow for the robot, and wide enough to look through.
    let ajar = HALL.replace("[5, 0.2]", "[4.5, 0.2]");
    assert!(warnings_of(&[(WALL, &ajar), far]).is_empty());
}

#[test]
fn areas_and_clusters_of_items_count_and_clutter_and_rare_corners_do_not() {
    let items = "placement = { kind = \"uniform\" }";
    let inside = "placement = { kind = \"uniform\", within_m = [[10, 10], [20, 20]] }";
    assert!(is_warned(
        &[(WALL, HALL), (items, inside)],
        "24.6% of its free area"
    ));
    let left = "placement = { kind = \"uniform\", within_m = [[0, 0], [9, 20]] }";
    assert!(warnings_of(&[(items, left)]).is_empty());
    let clusters = "placement = { kind = \"clustered\", clusters = 1, spread_m = 1 }";
    assert!(is_warned(&[(items, clusters)], "about 50% of runs"));
    assert!(warnings_of(&[("target = true", "target = false")]).is_empty());
    // A robot of 0.3 m comes no nearer to a corner than 0.42 m: 0.01% of the area is out of range.
    assert!(warnings_of(&[(WALL, ""), ("range_m = 0.5", "range_m = 0.35")]).is_empty());
    assert!(
        warnings_of(&[
            ("[20, 20], ob", "[20, 20], periodic = true, ob"),
            ("[0.2, 20]", "[0.2, 19]")
        ])
        .is_empty()
    );
}

#[test]
fn goals_count_for_the_robots_that_can_serve_them() {
    let goals = "[goals.job]\ncount = 4\nwithin_m = 1\n\n[controllers.base]\ncount = 1\n\
                 radio = { range_m = 100 }\n\n[robots.rover]\nradio = { range_m = 100 }\n\
                 brain = { behaviours = [{ kind = \"serve\" }] }";
    let sensors = "sensors = { gps = { kind = \"position\" }, compass = { kind = \"heading\" }, ";
    let changes = [
        ("[robots.rover]", goals),
        ("sensors = { ", sensors),
        (
            "max_speed_m_s = 0.5",
            "max_speed_m_s = 0.5, max_turn_rate_deg_s = 90",
        ),
        ("target = true", "target = false"),
    ];
    assert!(is_warned(
        &changes,
        "no robot that can serve it can reach 47"
    ));
    let found = warnings_of(&changes);
    assert!(found[0].contains("goals.job.placement"), "{found:?}");
}
