//! Checks of what the parts of a scenario mean together; one topic per file.

mod brains;
mod clearance;
mod clock;
mod controllers;
mod drive;
mod end;
mod goals;
mod ground;
mod items;
mod lane_outcomes;
mod memory;
mod names;
mod passage;
mod periodic;
mod places;
mod rates;
mod reach;
mod room;
mod sensors;
mod tools;

use super::checked::Checked;
use super::lane_sight;
use super::ready::Scenario;
use super::spec::ScenarioSpec;
use base::document::{Document, Place};
use base::error::{InputError, InputErrors};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// A check: the errors of a scenario at the place `at` in a document.
type Check = fn(&ScenarioSpec, &Place) -> Vec<InputError>;

/// Checks of what the conversion for runs relies on.
const CHECKS_OF_FORM: [Check; 8] = [
    clock::errors,
    names::errors,
    rates::errors,
    drive::errors,
    sensors::errors,
    items::errors,
    tools::errors,
    memory::errors,
];

/// A check of positions, in a world with the valid obstacles.
type CheckOfPlaces = fn(&Checked, &Place) -> Vec<InputError>;

const CHECKS_OF_PLACES: [CheckOfPlaces; 5] = [
    periodic::errors,
    places::errors,
    room::errors,
    reach::errors,
    passage::of_places,
];

/// The scenario of `spec`, which a document contains, if it has no errors.
pub(super) fn checked(spec: ScenarioSpec, document: &Document) -> Result<Checked, InputErrors> {
    let at = &document.place();
    let form = CHECKS_OF_FORM.iter().flat_map(|check| check(&spec, at));
    let form: Vec<InputError> = form.collect();
    let meaning = of_meaning(&spec, document);
    let mut of_places = Vec::new();
    let open = |name: &str| document.open(name);
    let solids = ground::solids(&spec.world, &at.key("world"), &open, &mut of_places);
    let areas = ground::areas(&spec.terrain, &at.key("terrain"), &mut of_places);
    if !form.is_empty() {
        return Err(InputErrors([form, meaning, of_places].concat()));
    }
    let scenario = Scenario::new(&spec, solids, areas).among_those_of(document);
    let checked = Checked { spec, scenario };
    let checked = match lane_sight::seen(&checked) {
        Some(seen) => Checked {
            scenario: checked.scenario.with_seen(&seen),
            ..checked
        },
        None => checked,
    };
    // An error in a world without the invalid obstacles is an error with them too.
    for check in CHECKS_OF_PLACES {
        let known = meaning.iter().chain(&of_places);
        let reported: BTreeSet<String> = known.map(|error| error.path.clone()).collect();
        let more = check(&checked, at).into_iter();
        of_places.extend(more.filter(|error| !reported.contains(&error.path)));
    }
    InputErrors::or([meaning, of_places].concat(), Some(checked))
}

/// Errors of behaviours, controllers, goals and the end. They need no valid numbers, and none of them prevents the
/// conversion for runs, so that errors of positions are reported with them.
pub(super) fn of_meaning(spec: &ScenarioSpec, document: &Document) -> Vec<InputError> {
    let at = &document.place();
    [
        brains::errors(spec, at),
        controllers::errors(spec, at),
        clearance::errors(spec, document),
        passage::errors(spec, at),
        goals::errors(spec, document),
        end::errors(spec, document),
    ]
    .concat()
}

/// The files of obstacles that have not been read.
pub(super) fn missing_files(spec: &ScenarioSpec, document: &Document) -> Vec<String> {
    let wanted = RefCell::new(Vec::new());
    let open = |name: &str| {
        if !document.has_file(name) {
            wanted.borrow_mut().push(name.to_owned());
        }
        document.open(name)
    };
    let at = document.place();
    let _ = ground::solids(&spec.world, &at.key("world"), &open, &mut Vec::new());
    wanted.into_inner()
}

#[cfg(test)]
mod tests;
