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
        let expected = "t.toml:10: robots.rover.sensors.scanner.rays = 36: 36 rays are 0.149 m apart at 0.86 m, where the \
                        robot must see an obstacle to stop from 1 m/s: it may touch corners and obstacles of 0.100 m \
                        between them; set at least 54 rays, or a lower speed";
        assert_eq!(found, [expected], "{thin}");
        assert_eq!(with(thin, "rays = 54").len(), 0);
        let half = with(thin, "rays = 20, fov_deg = 180");
        assert!(half[0].contains("set at least 28 rays"), "{half:?}");
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

#[test]
fn only_rays_ahead_that_reach_far_enough_count() {
    let behind = |range_m: f64, facing_deg: f64| {
        let rear = format!(
            "\nsensors.rear = {{ kind = \"range\", rays = 90, fov_deg = 90, range_m = {range_m}, facing_deg = {facing_deg} }}"
        );
        let text = ROVER
            .replace("OBSTACLE", BOX)
            .replace("SCANNER", "rays = 16");
        of(&text.replace("\nbrain.behav", &format!("{rear}\nbrain.behav"))).len()
    };
    assert_eq!(behind(8.0, 180.0), 1);
    assert_eq!(behind(0.3, 0.0), 1);
    assert_eq!(behind(8.0, 0.0), 0);
}

#[test]
fn the_rate_of_the_brain_counts_and_flying_robots_have_no_warning() {
    let text = ROVER.replace("OBSTACLE", THIN[2]);
    let text = text.replace("SCANNER", "rays = 54");
    assert_eq!(of(&text).len(), 0);
    let slow = of(&text.replace("\nbrain.behav", "\nbrain.rate_hz = 1\nbrain.behav"));
    assert_eq!(slow.len(), 1);
    let flying = text.replace("rays = 54", "rays = 16");
    let flying = flying.replace("radius_m = 0.2", "radius_m = 0.2\nlayer = \"air\"");
    assert_eq!(of(&flying).len(), 0);
}

#[test]
fn what_cannot_help_is_not_advised() {
    let tiny = "{ circle = { at_m = [5, 5], radius_m = 0.001 } }";
    assert!(with(tiny, "rays = 1000")[0].ends_with("set a lower speed"));
    assert!(with(tiny, "rays = 100")[0].ends_with("set up to 1440 rays and a lower speed"));
    let slow = ROVER
        .replace("OBSTACLE", BOX)
        .replace("SCANNER", "rays = 4");
    let slow = of(&slow.replace("max_speed_m_s = 1,", "max_speed_m_s = 0.001,"));
    assert!(slow[0].ends_with("set at least 32 rays"), "{slow:?}");
}
