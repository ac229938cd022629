use super::*;

/// The obstacle that the errors below are about.
const CIRCLE: &str = "{ circle = { at_m = [15, 5], radius_m = 1 } }";

/// The errors of the good scenario with another obstacle.
fn errors_of(obstacle: &str) -> Vec<String> {
    errors(CIRCLE, obstacle)
}

#[test]
fn a_copy_outside_of_the_world_is_reported_once_with_its_column_and_row() {
    let reported = errors_of(
        "{ circle = { at_m = [15, 5], radius_m = 1 }, repeat = { columns = 3, rows = 2, spacing_m = [2, 7] } }",
    );
    assert_eq!(
        reported,
        [
            "world.obstacles[1] = {...}: must be at least partly in the world, from [0, 0] to [20, 10]; the copy \
             in column 1 and row 2 is not"
        ]
    );
}

#[test]
fn copies_are_apart() {
    let repeat = |repeat: &str| {
        errors_of(&format!(
            "{{ circle = {{ at_m = [15, 5], radius_m = 1 }}, repeat = {{ {repeat} }} }}"
        ))
    };
    assert_eq!(
        repeat("columns = 3, spacing_m = [0, 2]"),
        [
            "world.obstacles[1].repeat.spacing_m = [0, 2]: must be other than 0 between copies: there are 3 along \
             x and 1 along y"
        ]
    );
    assert_eq!(
        repeat("columns = 1001, rows = 0, spacing_m = [inf, 2]"),
        [
            "world.obstacles[1].repeat.columns = 1001: must be a whole number from 1 to 1000",
            "world.obstacles[1].repeat.rows = 0: must be a whole number from 1 to 1000",
            "world.obstacles[1].repeat.spacing_m[0] = inf: must be a number",
        ]
    );
}

#[test]
fn repeated_obstacles_have_a_limited_number_of_corners_together() {
    let squares = |columns: u32| {
        format!(
            "{{ rectangle = {{ at_m = [15, 5], size_m = [1, 1] }}, \
             repeat = {{ columns = {columns}, rows = 125, spacing_m = [1e-6, 1e-6] }} }}"
        )
    };
    assert_eq!(
        errors_of(&format!("{}, {}, {CIRCLE}", squares(150), squares(51))),
        [
            "world.obstacles[2].repeat = {...}: must be fewer copies: all repeated obstacles together may have \
             100000 corners"
        ]
    );
}

#[test]
fn keys_of_a_shape_are_checked() {
    assert_eq!(
        errors_of(
            "{ rectangle = { at_m = [5, 5], size_m = [0, 2], rotaton_deg = 30 }, repaet = {} }"
        ),
        [
            "world.obstacles[1].rectangle.rotaton_deg is not a known key: expected one of at_m, size_m, \
             rotation_deg; did you mean rotation_deg?",
            "world.obstacles[1].rectangle.size_m[0] = 0: must be a number from 0.001 to 100000",
            "world.obstacles[1].repaet is not a known key: expected one of rectangle, repeat; did you mean repeat?",
        ]
    );
    let map = errors_of("{ map = \"room.yaml\", repeat = { columns = 2, spacing_m = [1, 1] } }");
    assert!(
        map[0].starts_with("world.obstacles[1].repeat is not a known key"),
        "{map:?}"
    );
}
