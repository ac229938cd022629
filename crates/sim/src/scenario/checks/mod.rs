//! Checks of what the parts of a scenario mean together; one topic per file.

mod brains;
mod clock;
mod controllers;
mod detection;
mod drive;
mod end;
mod goals;
mod ground;
mod memory;
mod names;
mod periodic;
mod places;
mod rates;
mod reach;
mod room;

use super::checked::Checked;
use super::ready::Scenario;
use super::spec::ScenarioSpec;
use base::document::{Document, Place};
use base::error::{InputError, InputErrors};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// A check: the errors of a scenario at the place `at` in a document.
type Check = fn(&ScenarioSpec, &Place) -> Vec<InputError>;

const CHECKS: [Check; 9] = [
    clock::errors,
    names::errors,
    rates::errors,
    drive::errors,
    detection::errors,
    brains::errors,
    controllers::errors,
    goals::errors,
    memory::errors,
];

/// A check of positions, in a world with the valid obstacles.
type CheckOfPlaces = fn(&Checked, &Place) -> Vec<InputError>;

const CHECKS_OF_PLACES: [CheckOfPlaces; 4] = [
    periodic::errors,
    places::errors,
    room::errors,
    reach::errors,
];

/// The scenario of `spec`, which a document contains, if it has no errors.
pub(super) fn checked(spec: ScenarioSpec, document: &Document) -> Result<Checked, InputErrors> {
    let at = &document.place();
    let mut errors: Vec<InputError> = CHECKS.iter().flat_map(|check| check(&spec, at)).collect();
    errors.extend(end::errors(&spec, document));
    let mut of_places = Vec::new();
    let open = |name: &str| document.open(name);
    let solids = ground::solids(&spec.world, &at.key("world"), &open, &mut of_places);
    let areas = ground::areas(&spec.terrain, &at.key("terrain"), &mut of_places);
    if !errors.is_empty() {
        return Err(InputErrors([errors, of_places].concat()));
    }
    let scenario = Scenario::new(&spec, solids, areas).among_those_of(document);
    let checked = Checked { spec, scenario };
    // An error in a world without the invalid obstacles is an error with them too.
    for check in CHECKS_OF_PLACES {
        let reported: BTreeSet<String> = of_places.iter().map(|error| error.path.clone()).collect();
        let more = check(&checked, at).into_iter();
        of_places.extend(more.filter(|error| !reported.contains(&error.path)));
    }
    InputErrors::or(of_places, Some(checked))
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
