use super::unseen_corners::warnings;
use crate::scenario::ScenarioSpec;
use base::document::Document;

const ROVER: &str = r#"
clock = { step_s = 0.1, time_limit_s = 60 }
world = { size_m = [10, 10], obstacles = [OBSTACLE] }
items.mine = { target = false, count = 1 }

[robots.rover]
count = 1
radius_m = 0.2
drive = { max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 120 }
sensors.scanner = { kind = "range", SCANNER, range_m = 8 }
brain.behaviours = [{ kind = "cruise" }, { kind = "avoid" }]
"#;

/// Walls of 0.1 m: slanted, upright, and of boxes that have one.
const THIN: [&str; 3] = [
    "{ polygon_m = [[4, 5], [4.06, 4.92], [5.66, 6.12], [5.6, 6.2]] }",
    "{ rectangle = { at_m = [5, 5], size_m = [0.1, 3], rotation_deg = 30 } }",
    "{ circle = { at_m = [5, 5], radius_m = 0.05 } }",
];

const BOX: &str = "{ rectangle = { at_m = [5, 5], size_m = [2, 1], rotation_deg = 30 } }";

fn with(obstacle: &str, scanner: &str) -> Vec<String> {
    let text = ROVER.replace("OBSTACLE", obstacle);
    of(&text.replace("SCANNER", scanner))
}

fn of(text: &str) -> Vec<String> {
    let document = Document::parse("t.toml", text).unwrap();
    let checked = ScenarioSpec::read(&document).unwrap();
    let found = warnings(&checked, &document.place());
    found.iter().map(ToString::to_string).collect()
}

/// The robot stops within 0.2 m + 1 / 1.8 m + 0.1 m, where 53 rays are 0.1 m apart.
#[test]
fn thin_obstacles_between_two_rays_have_a_warning_and_the_advised_number_of_rays_has_none() {
    for thin in THIN {
        let found = with(thin, "rays = 36");
        let expected = "t.toml:10: robots.rover.sensors.scanner.rays = 36: 36 rays are 0.15 m apart at 0.86 m, where the \
                        robot must see an obstacle to stop from 1 m/s: it may touch corners and obstacles of 0.10 m \
                        between them; set at least 54 rays, or a lower speed";
        assert_eq!(found, [expected], "{thin}");
        assert_eq!(with(thin, "rays = 54").len(), 0);
        assert_eq!(with(thin, "rays = 20, fov_deg = 180").len(), 1);
        assert_eq!(with(thin, "rays = 28, fov_deg = 180").len(), 0);
    }
}

#[test]
fn corners_of_boxes_have_a_warning_only_where_the_brain_does_not_count_them() {
    let found = with(BOX, "rays = 16");
    assert!(found[0].contains("it may touch corners between them; set at least 32 rays"));
    assert_eq!(with(BOX, "rays = 32").len(), 0);
    assert_eq!(with(BOX, "rays = 2").len(), 1);
}

#[test]
fn what_does_not_depend_on_rays_has_no_warning() {
    assert_eq!(with("", "rays = 4").len(), 0);
    assert_eq!(with(BOX, "rays = 1, fov_deg = 0").len(), 0);
    let text = ROVER
        .replace("OBSTACLE", BOX)
        .replace("SCANNER", "rays = 16");
    let second = "\nsensors.fine = { kind = \"range\", rays = 360, range_m = 8 }\nbrain.behav";
    assert_eq!(of(&text.replace("\nbrain.behav", second)).len(), 0);
    let free = "\nbrain.limit_speed_to_stopping_distance = false\nbrain.behav";
    assert_eq!(of(&text.replace("\nbrain.behav", free)).len(), 0);
    assert_eq!(
        of(&text.replace("max_speed_m_s = 1,", "max_speed_m_s = 0.1,")).len(),
        0
    );
}
