//! The error for a key or value of an earlier version names the new one.

use super::read;
use base::document::renamed::{KEYS, VALUES};

/// A scenario in which every renamed key and value has a place, by its new name.
const SCENARIO: &str = r#"
clock = { time_limit_s = 60 }
items.mine = { count = 1, target = true }
[world]
size_m = [20, 10]
periodic = false
obstacles = [{ map = "room.yaml", unknown_is_occupied = true }]
[robots.rover]
model = "ugv"
count = 1
collision = { max_collisions = 3, stop_duration_s = 1 }
radio = { range_m = 5, loss_probability = 0.1 }
[robots.rover.sensors.sonar]
kind = "range"
rays = 8
range_m = 2
miss_probability = 0.1
spurious_return_probability = 0.1
relative_noise = 0.1
dropout_probability = 0.1
[robots.rover.sensors.eye]
kind = "items"
range_m = 3
detection_probability = { mine = { peak = 0.9, half_range_m = 2 } }
false_alarm_rate_per_m2_s = { mine = 0.01 }
[robots.rover.brain]
limit_speed_to_stopping_distance = true
arbitration = { kind = "schemas", max_noise = 2 }
beliefs = { prior_count = { mine = 2 }, trust = { adaptive = true } }
behaviours = [
    { kind = "random_bounce" },
    { kind = "lawnmower" },
    { kind = "bayesian_search" },
    { kind = "hold_position" },
    { kind = "return_home", min_charge = 0.2, reserve_factor = 1.5 },
    { kind = "flock" },
    { kind = "navigate", waypoints_m = [[1, 1]], assignment = "one_each" },
    { kind = "avoid", near_m = 0.2, clearance_hysteresis_m = 0.1, reverse_distance_m = 0.3 },
]
"#;

/// The errors of the scenario with `old` in place of `new`.
fn errors(new: &str, old: &str) -> Vec<String> {
    assert!(SCENARIO.contains(new), "{new}");
    let errors = read(&SCENARIO.replacen(new, old, 1)).unwrap_err().0;
    errors.iter().map(ToString::to_string).collect()
}

#[test]
fn the_error_of_an_old_key_names_the_new_one() {
    assert_eq!((KEYS.len(), VALUES.len()), (26, 8));
    for (old, new) in KEYS {
        let errors = errors(&format!("{new} = "), &format!("{old} = "));
        let is_meant = |error: &&String| {
            error.contains(&format!("{old} was renamed: use ")) && error.ends_with(new)
        };
        assert_eq!(errors.iter().filter(is_meant).count(), 1, "{errors:?}");
        assert!(!errors.concat().contains("is missing"), "{errors:?}");
    }
}

#[test]
fn the_error_of_an_old_value_names_the_new_one() {
    let scenario = SCENARIO.replace("one_each", "shared");
    for (old, new) in VALUES {
        let text = if new == "shared" { &scenario } else { SCENARIO };
        let [old, new] = [old, new].map(|name| format!("\"{name}\""));
        assert!(text.contains(&new), "{new}");
        let errors = read(&text.replacen(&new, &old, 1)).unwrap_err().to_string();
        let message = format!("= {old} was renamed: use {new}");
        assert!(errors.contains(&message), "{message}\nnot in\n{errors}");
    }
}
