//! The configurations of a study that show where there is no room.

use base::document::{Document, Value};
use std::collections::BTreeMap;

/// Maximum number of worlds and bodies that are examined.
const MAX_GROUPS: usize = 16;

/// Origin of a configuration's values, as in errors.
const ORIGIN: &str = "study.vary";

type Configuration = [(String, Value)];

/// Configurations with the same worlds and the same bodies, which differ in the sizes of teams.
type Group<'c> = Vec<&'c Configuration>;

/// The documents of those `configurations` whose start areas are fullest.
///
/// Only the world and the bodies of robots matter, and more robots need more room: of the configurations
/// that are equal otherwise, these are the largest team and the largest number of each kind.
pub(super) fn representative(
    document: &Document,
    configurations: &[Vec<(String, Value)>],
) -> Vec<Document> {
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    for configuration in configurations {
        let group = groups.entry(world_and_bodies(configuration)).or_default();
        group.push(configuration);
    }
    let mut groups: Vec<Group> = groups.values().map(largest).collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.first().map(|each| team_size(each))));
    let examined = groups.iter().take(MAX_GROUPS).flatten();
    examined.map(|each| applied(document, each)).collect()
}

/// The values that determine the world and the bodies, as text.
fn world_and_bodies(configuration: &Configuration) -> String {
    let others = configuration.iter().filter(|(path, _)| {
        let keys: Vec<&str> = path.split('.').collect();
        match keys[..] {
            ["world", ..] => true,
            ["robots" | "models", _, key, ..] => {
                matches!(key, "model" | "layer" | "radius_m" | "start")
            }
            _ => false,
        }
    });
    let others: Vec<String> = others
        .map(|(path, value)| format!("{path} = {value}"))
        .collect();
    others.join(", ")
}

/// The numbers of robots that a configuration sets, by path.
fn counts(configuration: &Configuration) -> impl Iterator<Item = (&str, i64)> {
    configuration.iter().filter_map(|(path, value)| {
        let keys: Vec<&str> = path.split('.').collect();
        match (&keys[..], value) {
            (["robots", _, "count"], Value::Integer(count)) => Some((path.as_str(), *count)),
            _ => None,
        }
    })
}

fn team_size(configuration: &Configuration) -> i64 {
    counts(configuration).map(|(_, count)| count).sum()
}

/// The largest team of a group, and those with the largest number of each kind.
fn largest<'c>(group: &Group<'c>) -> Group<'c> {
    let mut largest: BTreeMap<&str, (i64, i64, &Configuration)> = BTreeMap::new();
    for configuration in group {
        let size = team_size(configuration);
        for (path, count) in counts(configuration).chain([("", size)]) {
            let best = largest.entry(path).or_insert((count, size, configuration));
            if (count, size) > (best.0, best.1) {
                *best = (count, size, configuration);
            }
        }
    }
    let mut chosen: Group = Vec::new();
    for (.., configuration) in largest.into_values() {
        if !chosen.contains(&configuration) {
            chosen.push(configuration);
        }
    }
    chosen
}

/// The document of a configuration. Values that it has anyway keep their lines.
fn applied(document: &Document, configuration: &Configuration) -> Document {
    let mut document = document.clone();
    for (path, value) in configuration {
        let keys: Vec<&str> = path.split('.').collect();
        if document.get(&keys).is_none_or(|node| node.value != *value) {
            document.set(&keys, value.clone(), ORIGIN);
        }
    }
    document
}
