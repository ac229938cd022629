//! The configurations of a study that show where there is no room, and where no robot comes.

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
pub(super) fn largest_teams(
    document: &Document,
    configurations: &[Vec<(String, Value)>],
) -> Vec<Document> {
    let chosen = chosen(configurations, |group| extreme(group, |count| count));
    let documents = chosen.into_iter().map(|each| applied(document, each));
    documents.collect()
}

/// The documents of those `configurations` whose robots reach the fewest places, each with its numbers of robots in
/// words: of the configurations that are equal otherwise, the smallest team and the smallest number of each kind.
pub(super) fn smallest_teams(
    document: &Document,
    configurations: &[Vec<(String, Value)>],
) -> Vec<(Document, String)> {
    let chosen = chosen(configurations, |group| {
        let mut teams = group.clone();
        teams.retain(|each| counts(each).next().is_none() || team_size(each) > 0);
        extreme(&teams, |count| -count)
    });
    let documents = chosen.into_iter().map(|each| {
        let counts = counts(each).map(|(path, count)| format!("{path} = {count}"));
        let counts: Vec<String> = counts.collect();
        (applied(document, each), counts.join(", "))
    });
    documents.collect()
}

/// The configurations that are chosen from each group, those of the largest teams first.
fn chosen<'c>(
    configurations: &'c [Vec<(String, Value)>],
    choose: impl Fn(&Group<'c>) -> Group<'c>,
) -> Vec<&'c Configuration> {
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    for configuration in configurations {
        let group = groups.entry(world_and_bodies(configuration)).or_default();
        group.push(configuration);
    }
    let mut groups: Vec<Group> = groups.values().map(choose).collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.first().map(|each| team_size(each))));
    groups.into_iter().take(MAX_GROUPS).flatten().collect()
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

/// The team of a group whose size has the highest rank, and those whose number of each kind has.
fn extreme<'c>(group: &Group<'c>, rank: impl Fn(i64) -> i64) -> Group<'c> {
    let mut highest: BTreeMap<&str, (i64, i64, &Configuration)> = BTreeMap::new();
    for configuration in group {
        let size = rank(team_size(configuration));
        let counts = counts(configuration).map(|(path, count)| (path, rank(count)));
        for (path, count) in counts.chain([("", size)]) {
            let best = highest.entry(path).or_insert((count, size, configuration));
            if (count, size) > (best.0, best.1) {
                *best = (count, size, configuration);
            }
        }
    }
    let mut chosen: Group = Vec::new();
    for (.., configuration) in highest.into_values() {
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
