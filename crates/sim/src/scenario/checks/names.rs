//! Checks of names: they appear in columns, paths and options.

use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;
use base::random::kind_key;
use std::collections::BTreeMap;

/// Kinds of robots are counted in one byte of their ids.
const MAX_KINDS: usize = 255;

/// Maximum number of sensors of a robot: one bit per sensor stores whether it is off.
const MAX_SENSORS: usize = 32;

/// Maximum length of a name.
const MAX_LENGTH: usize = 64;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let robots = at.key("robots");
    let mut errors = errors_of(&names(&spec.robots), 1, MAX_KINDS, &robots);
    errors.extend(errors_of(
        &names(&spec.items),
        0,
        MAX_KINDS,
        &at.key("items"),
    ));
    errors.extend(errors_of(
        &names(&spec.models),
        0,
        MAX_KINDS,
        &at.key("models"),
    ));
    errors.extend(errors_of(
        &names(&spec.terrain),
        0,
        MAX_KINDS,
        &at.key("terrain"),
    ));
    let controllers = at.key("controllers");
    let left = MAX_KINDS.saturating_sub(spec.robots.len());
    errors.extend(errors_of(&names(&spec.controllers), 0, left, &controllers));
    errors.extend(errors_of(
        &names(&spec.goals),
        0,
        MAX_KINDS,
        &at.key("goals"),
    ));
    errors.extend(twins(&names(&spec.robots), &robots));
    errors.extend(twins(&names(&spec.controllers), &controllers));
    errors.extend(robots_and_controllers(spec, &controllers));
    errors.extend(twins(&names(&spec.goals), &at.key("goals")));
    errors.extend(twins(&names(&spec.items), &at.key("items")));
    errors.extend(time_columns(&names(&spec.items), &at.key("items")));
    for (name, kind) in &spec.controllers {
        let sensors = controllers.key(name).key("sensors");
        errors.extend(errors_of(&names(&kind.sensors), 0, MAX_SENSORS, &sensors));
    }
    for (name, robot) in &spec.robots {
        let sensors = robots.key(name).key("sensors");
        errors.extend(errors_of(&names(&robot.sensors), 0, MAX_SENSORS, &sensors));
        let capabilities = robots.key(name).key("capabilities");
        let bad = robot.capabilities.iter().enumerate();
        let bad = bad.filter(|(_, name)| !is_fine(name));
        errors.extend(bad.map(|(number, _)| capabilities.item(number).error(allowed())));
    }
    errors
}

fn names<T>(table: &BTreeMap<String, T>) -> Vec<&str> {
    table.keys().map(String::as_str).collect()
}

fn errors_of(names: &[&str], least: usize, most: usize, at: &Place) -> Vec<InputError> {
    let bad = names.iter().filter(|name| !is_fine(name));
    let mut errors: Vec<InputError> = bad
        .map(|name| at.key(name).error(format!("under {}", allowed())))
        .collect();
    if !(least..=most).contains(&names.len()) {
        let allowed = format!("a table of {least} to {most}; it has {}", names.len());
        errors.push(at.error(allowed));
    }
    errors
}

/// What names may be.
pub(super) fn allowed() -> String {
    format!("a name of at most {MAX_LENGTH} letters a to z or A to Z, digits, _ and -")
}

/// Controllers that would have the names or the random numbers of robots.
fn robots_and_controllers(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let robots: BTreeMap<u32, &String> = spec
        .robots
        .keys()
        .map(|name| (kind_key(name), name))
        .collect();
    let same = spec.controllers.keys().filter_map(|name| {
        let robot = robots.get(&kind_key(name))?;
        let allowed = format!("a different name: the kind of robots {robot} has it, or its hash");
        Some(at.key(name).error(allowed))
    });
    same.collect()
}

/// Kinds that would have the random numbers of another kind.
fn twins(names: &[&str], at: &Place) -> Vec<InputError> {
    let mut known = BTreeMap::new();
    let twins = names.iter().filter_map(|name| {
        let other = *known.entry(kind_key(name)).or_insert(*name);
        (other != *name).then(|| {
            at.key(name).error(format!(
                "a different name: the hash that keys its random numbers equals that of {other}"
            ))
        })
    });
    twins.collect()
}

/// Kinds of items whose count would have the name of another column.
fn time_columns(names: &[&str], at: &Place) -> Vec<InputError> {
    let ambiguous = names.iter().filter_map(|name| {
        let (other, number) = name.strip_suffix("_s")?.rsplit_once('_')?;
        let is_number = number.chars().all(|c| c.is_ascii_digit());
        (is_number && names.contains(&other)).then(|| {
            at.key(name).error(format!(
                "a different name: found_{name} is the time of a find of {other}"
            ))
        })
    });
    ambiguous.collect()
}

pub(super) fn is_fine(name: &str) -> bool {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    (1..=MAX_LENGTH).contains(&name.len()) && name.chars().all(is_bare)
}
