//! Warnings about scenarios: what is allowed, and probably not meant.
//!
//! They are not part of reading a scenario: every configuration of a study is read, and warnings are
//! needed once.

mod configurations;
mod cropped_maps;
mod economy;
mod goals;
mod lane_radios;
pub(crate) mod lane_reach;
mod lane_work;
mod majority;
mod narrow_radios;
mod out_of_reach;
mod position_errors;
mod room;
mod unseen_corners;

use crate::scenario::{Checked, ScenarioSpec};
use base::document::{Document, Place, Value};
use base::warning::Warning;

/// Maximum number of warnings.
const MAX_WARNINGS: usize = 10;

/// Warnings about a scenario at a place in a document.
type Examination = fn(&Checked, &Place) -> Vec<Warning>;

const EXAMINATIONS: [Examination; 11] = [
    cropped_maps::warnings,
    room::warnings,
    goals::warnings,
    economy::warnings,
    majority::warnings,
    narrow_radios::warnings,
    lane_radios::warnings,
    lane_reach::warnings,
    lane_work::warnings,
    position_errors::warnings,
    unseen_corners::warnings,
];

/// Warnings about `configurations` of a document, each with values by path. Invalid configurations have
/// none: their errors are reported when they are read.
pub(crate) fn warnings(
    document: &Document,
    configurations: &[Vec<(String, Value)>],
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut add = |warning: Warning| {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    };
    let largest = configurations::largest_teams(document, configurations);
    let smallest = configurations::smallest_teams(document, configurations);
    let is_varied = smallest.iter().any(|(_, team)| !team.is_empty());
    let compared = largest.iter().filter(|_| is_varied);
    let in_largest: Vec<Warning> = compared.flat_map(unreached).collect();
    for (document, team) in smallest {
        for mut warning in unreached(&document) {
            // Otherwise, it is the same with any number of robots.
            if !team.is_empty() && !in_largest.contains(&warning) {
                warning.effect = format!("with {team}: {}", warning.effect);
            }
            add(warning);
        }
    }
    for document in largest {
        let Ok(checked) = ScenarioSpec::read(&document) else {
            continue;
        };
        let found = EXAMINATIONS.iter();
        let found = found.flat_map(|examine| examine(&checked, &document.place()));
        found.for_each(&mut add);
    }
    warnings.truncate(MAX_WARNINGS);
    warnings
}

/// Warnings about parts of the world that no robot of a team reaches: fewer robots reach less.
fn unreached(document: &Document) -> Vec<Warning> {
    let checked = ScenarioSpec::read(document);
    checked.map_or_else(
        |_| Vec::new(),
        |checked| out_of_reach::warnings(&checked, &document.place()),
    )
}

#[cfg(test)]
mod economy_tests;
#[cfg(test)]
mod lane_radios_tests;
#[cfg(test)]
mod lane_reach_tests;
#[cfg(test)]
mod out_of_reach_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod unseen_corners_tests;
