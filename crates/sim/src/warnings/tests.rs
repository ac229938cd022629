use super::*;
use base::document::Files;

/// A world of 10 m by 10 m with a map of the same size, and two kinds of robots.
const JOB: &str = r#"
clock = { time_limit_s = 60 }
world = { size_m = [10, 10], obstacles = [{ map = "map.yaml" }] }

[robots.rover]
count = 4
radius_m = 0.2
start = { kind = "uniform", within_m = [[0, 0], [2, 10]] }
drive = { max_speed_m_s = 0.5 }

[robots.scout]
count = 2
radius_m = 0.1
drive = { max_speed_m_s = 0.5 }
"#;

/// A wall on the left, and one in the middle: 20 occupied cells.
const ROW: &str = "0 254 254 254 0 254 254 254 254 205 ";

fn document(text: &str, origin: &str) -> Document {
    let yaml = format!(
        "image: room.pgm\nresolution: 1.0\norigin: {origin}\nnegate: 0\noccupied_thresh: 0.65\n\
         free_thresh: 0.196\nmode: trinary\n"
    );
    let image = format!("P2 10 10 255 {}", ROW.repeat(10));
    let files = [("map.yaml", yaml), ("room.pgm", image)];
    let files: Files = files
        .map(|(name, text)| (name.to_owned(), Ok(text.into_bytes())))
        .into();
    Document::parse("t.toml", text).unwrap().with_files(files)
}

fn warnings_of(text: &str, origin: &str) -> Vec<String> {
    let document = document(text, origin);
    ScenarioSpec::read(&document).unwrap();
    shown(&warnings(&document, &[Vec::new()]))
}

fn shown(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(ToString::to_string).collect()
}

fn without_map(text: &str) -> String {
    text.replace(", obstacles = [{ map = \"map.yaml\" }]", "")
}

#[test]
fn a_map_in_the_world_has_no_warning() {
    let none: [&str; 0] = [];
    assert_eq!(warnings_of(JOB, "[0, 0, 0]"), none);
    // Only the margin of free and unknown cells is outside.
    assert_eq!(warnings_of(JOB, "[5, 0, 0]"), none);
}

#[test]
fn the_usual_negative_origin_crops_a_map_and_the_advice_holds_all_of_it() {
    assert_eq!(
        warnings_of(JOB, "[-5, -5, 0]"),
        [
            "t.toml:3: world.obstacles[0].map = \"map.yaml\": 100% of its occupied cells are outside of the \
             world, from [0, 0] to [10, 10], and are ignored; at_m = [0, 0] holds all of the map"
        ]
    );
    let cropped = "t.toml:3: world.obstacles[0].map = \"map.yaml\": 75% of its occupied cells are outside of \
                   the world, from [0, 0] to [10, 10], and are ignored; ";
    assert_eq!(
        warnings_of(JOB, "[-2, -5, 0]"),
        [format!("{cropped}at_m = [0, 0] holds all of the map")]
    );
    let placed = JOB.replace("\"map.yaml\"", "\"map.yaml\", at_m = [0, 0]");
    assert!(warnings_of(&placed, "[-2, -5, 0]").is_empty());
}

#[test]
fn a_map_after_copies_of_a_shape_is_named_by_its_entry() {
    let rectangle = "{ rectangle = { at_m = [9, 9], size_m = [1, 1] }, repeat = { columns = 2, spacing_m = [-2, 0] } }";
    let text = JOB.replace("[{ map", &format!("[{rectangle}, {{ map"));
    let found = warnings_of(&text, "[-5, -5, 0]");
    assert!(
        found[0].starts_with("t.toml:3: world.obstacles[1].map = "),
        "{found:?}"
    );
}

#[test]
fn a_larger_world_is_advised_where_the_map_does_not_fit() {
    let small = JOB
        .replace("[10, 10],", "[8, 12],")
        .replace("[2, 10]", "[2, 8]");
    let reported = warnings_of(&small, "[2, 4, 1.5707963267948966]");
    assert_eq!(
        reported,
        [
            "t.toml:3: world.obstacles[0].map = \"map.yaml\": 80% of its occupied cells are outside of the \
             world, from [0, 0] to [8, 12], and are ignored; world.size_m = [10, 14] with at_m = [10, 4] \
             holds all of the map"
        ]
    );
    let advised = small
        .replace("[8, 12]", "[10, 14]")
        .replace("\"map.yaml\"", "\"map.yaml\", at_m = [10, 4]");
    assert!(warnings_of(&advised, "[2, 4, 1.5707963267948966]").is_empty());
}

#[test]
fn a_start_area_that_is_too_small_has_a_warning_with_the_number_that_fits() {
    let crowded = without_map(JOB).replace("count = 4", "count = 120");
    let reported = warnings_of(&crowded, "[0, 0, 0]");
    assert_eq!(reported.len(), 1, "{reported:?}");
    let start = "t.toml:6: robots.rover.count = 120: no room: their start area, from [0, 0] to [2, 10], \
                 holds about ";
    let rest = reported[0].strip_prefix(start).unwrap();
    let (number, rest) = rest.split_once(' ').unwrap();
    assert_eq!(
        rest,
        "of them beside the others; runs without room are quarantined"
    );
    let number: u32 = number.parse().unwrap();
    let fitting = without_map(JOB).replace("count = 4", &format!("count = {}", number - 10));
    assert!(warnings_of(&fitting, "[0, 0, 0]").is_empty(), "{number}");
}

#[test]
fn more_robots_than_fit_at_the_densest_packing_are_never_placed() {
    // In a world of 1 km, whose area is enough, a strip of 20 m by 1 km.
    let large = without_map(JOB)
        .replace("size_m = [10, 10]", "size_m = [1000, 1000]")
        .replace("[2, 10]", "[20, 1000]")
        .replace("count = 4", "count = 1000000");
    let start = std::time::Instant::now();
    assert_eq!(
        warnings_of(&large, "[0, 0, 0]"),
        [
            "t.toml:6: robots.rover.count = 1000000: no room: their start area, from [0, 0] to [20, 1000], \
             holds at most 145386 of them; runs without room are quarantined"
        ]
    );
    assert!(start.elapsed().as_secs() < 2, "{:?}", start.elapsed());
}

#[test]
fn robots_that_rarely_fit_are_reported_with_the_number_of_such_runs() {
    // Two discs of 0.45 m in a corner of 1.4 m: the first is often in the way.
    let tight = without_map(JOB)
        .replace("count = 4", "count = 2")
        .replace("radius_m = 0.2", "radius_m = 0.45")
        .replace("[2, 10]", "[1.4, 1.4]");
    let reported = warnings_of(&tight, "[0, 0, 0]").concat();
    assert!(reported.contains("of 5 trial runs: their"), "{reported}");
    assert!(reported.contains("holds about 1 of them"), "{reported}");
}

#[test]
fn of_a_study_the_largest_teams_are_examined_in_every_world() {
    let text = without_map(JOB);
    let configurations: Vec<Vec<(String, Value)>> = (1..=300)
        .flat_map(|rovers| (1..=3).map(move |scouts| (rovers, scouts)))
        .flat_map(|(rovers, scouts)| [0.1, 0.2].map(|radius_m| (rovers, scouts, radius_m)))
        .map(|(rovers, scouts, radius_m)| {
            vec![
                ("robots.rover.count".to_owned(), Value::Integer(rovers)),
                ("robots.scout.count".to_owned(), Value::Integer(scouts)),
                ("robots.rover.radius_m".to_owned(), Value::Float(radius_m)),
            ]
        })
        .collect();
    let document = document(&text, "[0, 0, 0]");
    assert_eq!(
        configurations::largest_teams(&document, &configurations).len(),
        2
    );
    let reported = shown(&warnings(&document, &configurations));
    assert_eq!(reported.len(), 1, "{reported:?}");
    assert!(
        reported[0].starts_with("study.vary: robots.rover.count = 300: no room: their start area,"),
        "{reported:?}"
    );
    // A value that the file has anyway keeps its line.
    let own = vec![("robots.rover.count".to_owned(), Value::Integer(4))];
    let documents = configurations::largest_teams(&document, &[own]);
    assert_eq!(documents, [document]);
}

#[test]
fn an_invalid_configuration_has_no_warning_of_its_own() {
    let document = document(&without_map(JOB), "[0, 0, 0]");
    let negative = vec![("robots.rover.count".to_owned(), Value::Integer(-1))];
    assert!(warnings(&document, &[negative]).is_empty());
}

/// The warnings for a rover that visits a waypoint, with a goal of these keys.
fn warnings_of_goals(behaviour: &str, goal: &str, controllers: u32) -> String {
    let rover = "sensors = { gps = { kind = \"position\" }, compass = { kind = \"heading\" } }\nradio = { range_m = 9 }\n";
    let brain = format!("brain = {{ behaviours = [{{ {behaviour} }}, {{ kind = \"serve\" }}] }}\n");
    let text = without_map(JOB).replace(
        "[robots.rover]\n",
        &format!("[robots.rover]\n{rover}{brain}"),
    ) + &format!(
        "[controllers.base]\ncount = {controllers}\nradio = {{ range_m = 9 }}\n[goals.spot]\ncount = 1\n{goal}\n"
    );
    warnings_of(&text, "[0, 0, 0]").concat()
}

#[test]
fn goals_that_no_robot_serves_without_controllers_have_a_warning() {
    let navigate = "kind = \"navigate\", waypoints_m = [[5, 5]]";
    let there = "placement = { kind = \"fixed\", at_m = [[5, 5]] }";
    let takes_time = format!("{there}\nservice_s = 5");
    assert_eq!(warnings_of_goals(navigate, there, 0), "");
    assert_eq!(warnings_of_goals(navigate, &takes_time, 1), "");
    let left = warnings_of_goals(navigate, &takes_time, 0);
    assert!(
        left.contains("goals.spot.service_s = 5: without controllers"),
        "{left}"
    );
    assert!(left.ends_with("does not stay at its waypoints"), "{left}");
    for unvisited in [
        warnings_of_goals(navigate, "", 0),
        warnings_of_goals("kind = \"cruise\"", there, 0),
    ] {
        assert!(
            unvisited.contains("goals.spot = {...}: no robot serves them"),
            "{unvisited}"
        );
    }
}

/// A robot that is to reach a waypoint within 0.5 m, and its position sensor.
fn with_sensor(sensor: &str) -> String {
    let brain = "brain = { behaviours = [{ kind = \"cruise\" }, { kind = \"correct\", waypoints_m = [[5, 5]] }] }";
    let sensors = format!(
        "sensors = {{ gps = {{ kind = \"position\", {sensor} }}, compass = {{ kind = \"heading\" }} }}"
    );
    without_map(JOB).replace("count = 4", &format!("count = 4\n{brain}\n{sensors}"))
}

#[test]
fn a_place_within_less_than_twice_the_error_of_the_position_has_a_warning() {
    let none: [&str; 0] = [];
    assert_eq!(
        warnings_of(&with_sensor("noise_m = 0.25"), "[0, 0, 0]"),
        none
    );
    let found = warnings_of(&with_sensor("noise_m = 0.3"), "[0, 0, 0]");
    let expected = "robots.rover.brain.behaviours[1].within_m: 0.5 m is less than twice the error of the position \
                    sensor, 0.300 m";
    assert!(found[0].contains(expected), "{found:?}");
    let found = warnings_of(&with_sensor("drift_m = 0.3"), "[0, 0, 0]");
    assert!(
        found[0].contains("each such place is impossible"),
        "{found:?}"
    );
}
