//! Names of version 0.1 that have changed, so that the error for an old name states the new one.
//!
//! To be removed at 1.0.

use super::node::path_of;
use crate::error::InputError;

/// Keys, as (old, new). An old key is reported as renamed where the new one is allowed.
pub const KEYS: [(&str, &str); 26] = [
    ("back_off_m", "reverse_distance_m"),
    ("below", "min_charge"),
    ("best", "peak"),
    ("breaks_after", "max_collisions"),
    ("cap_s", "time_limit_s"),
    ("clear_by_m", "clearance_hysteresis_m"),
    ("detects", "detection_probability"),
    ("dropout", "dropout_probability"),
    ("expected", "prior_count"),
    ("false_alarms_per_m2_s", "false_alarm_rate_per_m2_s"),
    ("false_echo", "spurious_return_probability"),
    ("half_m", "half_range_m"),
    ("learns", "adaptive"),
    ("like", "model"),
    ("loss", "loss_probability"),
    ("margin", "reserve_factor"),
    ("miss", "miss_probability"),
    ("most_noise", "max_noise"),
    ("noise_share", "relative_noise"),
    ("places_m", "waypoints_m"),
    ("share", "assignment"),
    ("sought", "target"),
    ("speed_limited_by_sight", "limit_speed_to_stopping_distance"),
    ("stop_s", "stop_duration_s"),
    ("unknown_is_solid", "unknown_is_occupied"),
    ("wraps", "periodic"),
];

/// Values, as (old, new). An old value is reported as renamed where the new one is allowed.
pub const VALUES: [(&str, &str); 8] = [
    ("bounce", "random_bounce"),
    ("each", "one_each"),
    ("hold", "hold_position"),
    ("home", "return_home"),
    ("lanes", "lawnmower"),
    ("seek", "bayesian_search"),
    ("swarm", "flock"),
    ("team", "shared"),
];

/// The new name of `key`, if it has been renamed to one of `known`.
pub(crate) fn key<'k>(key: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    renamed(&KEYS, key, known)
}

/// The new name of `value`, if it has been renamed to one of `known`.
pub(crate) fn value<'k>(value: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    renamed(&VALUES, value, known)
}

/// `path` with the new names of its keys, if it is then one of `known`.
pub(crate) fn path<'k>(path: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let newest = |key: &str| {
        let mut renamed = KEYS.iter().filter(|(old, _)| *old == key);
        renamed
            .next()
            .map_or(key.to_owned(), |(_, new)| (*new).to_owned())
    };
    let keys: Vec<String> = path.split('.').map(newest).collect();
    let path_now = keys.join(".");
    known
        .into_iter()
        .find(|known| *known == path_now && path_now != path)
}

/// The error of a `key` in the table at `path` that is none of the `known`: a renamed or an unknown one.
pub(super) fn unknown_key<'k>(
    path: &str,
    key: &str,
    value: String,
    known: impl Iterator<Item = &'k str> + Clone,
) -> InputError {
    let at = path_of(path, key);
    match self::key(key, known.clone()) {
        Some(new) => InputError::renamed(at, None, path_of(path, new)),
        None => InputError::unknown_key(at, key, value, known),
    }
}

fn renamed<'k>(
    table: &[(&str, &str)],
    name: &str,
    known: impl IntoIterator<Item = &'k str>,
) -> Option<&'k str> {
    known
        .into_iter()
        .find(|known| table.contains(&(name, known)))
}
