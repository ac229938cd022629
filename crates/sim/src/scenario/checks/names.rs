//! Names that columns, paths and options can hold.

use super::ScenarioSpec;
use base::document::Place;
use base::fault::Fault;
use base::random::kind_key;
use std::collections::BTreeMap;

/// Robots' kinds are counted in a byte of their ids.
const MAX_KINDS: usize = 255;

/// Most sensors of a robot: which are off is a bit for each.
const MAX_SENSORS: usize = 32;

/// Most characters of a name.
const MAX_LENGTH: usize = 64;

pub(super) fn faults(spec: &ScenarioSpec, at: &Place) -> Vec<Fault> {
    let robots = at.key("robots");
    let mut faults = faults_of(&names(&spec.robots), 1, MAX_KINDS, &robots);
    faults.extend(faults_of(
        &names(&spec.items),
        0,
        MAX_KINDS,
        &at.key("items"),
    ));
    faults.extend(faults_of(
        &names(&spec.terrain),
        0,
        MAX_KINDS,
        &at.key("terrain"),
    ));
    faults.extend(twins(&names(&spec.robots), &robots));
    faults.extend(twins(&names(&spec.items), &at.key("items")));
    for (name, robot) in &spec.robots {
        let sensors = robots.key(name).key("sensors");
        faults.extend(faults_of(&names(&robot.sensors), 0, MAX_SENSORS, &sensors));
    }
    faults
}

fn names<T>(table: &BTreeMap<String, T>) -> Vec<&str> {
    table.keys().map(String::as_str).collect()
}

fn faults_of(names: &[&str], least: usize, most: usize, at: &Place) -> Vec<Fault> {
    let bad = names.iter().filter(|name| !is_fine(name));
    let mut faults: Vec<Fault> = bad
        .map(|name| {
            at.key(name).fault(format!(
                "under a name of at most {MAX_LENGTH} letters a to z or A to Z, digits, _ and -"
            ))
        })
        .collect();
    if !(least..=most).contains(&names.len()) {
        let allowed = format!("a table of {least} to {most}; it has {}", names.len());
        faults.push(at.fault(allowed));
    }
    faults
}

/// Kinds that would have the random numbers of another.
fn twins(names: &[&str], at: &Place) -> Vec<Fault> {
    let mut known = BTreeMap::new();
    let twins = names.iter().filter_map(|name| {
        let other = *known.entry(kind_key(name)).or_insert(*name);
        (other != *name).then(|| {
            at.key(name).fault(format!(
                "under another name: random numbers go by a hash of it, which is that of {other} too"
            ))
        })
    });
    twins.collect()
}

fn is_fine(name: &str) -> bool {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    (1..=MAX_LENGTH).contains(&name.len()) && name.chars().all(is_bare)
}
