//! What the parts of a scenario mean together; one thing a file.

mod brains;
mod clock;
mod detection;
mod drive;
mod ground;
mod memory;
mod names;
mod periodic;
mod places;
mod rates;
mod reach;
mod room;

use super::{Checked, Scenario, ScenarioSpec};
use base::document::{Document, Place};
use base::error::{InputError, InputErrors};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Gives the bytes of a file that a scenario names, or says why it cannot.
type Open<'o> = &'o dyn Fn(&str) -> Result<Vec<u8>, String>;

/// A check: what is wrong with a scenario that stands `at` the root of a document.
type Check = fn(&ScenarioSpec, &Place) -> Vec<InputError>;

const CHECKS: [Check; 7] = [
    clock::errors,
    names::errors,
    rates::errors,
    drive::errors,
    detection::errors,
    brains::errors,
    memory::errors,
];

/// A check of what stands where, in a world of the obstacles that are right.
type CheckOfPlaces = fn(&Checked, &Place) -> Vec<InputError>;

const CHECKS_OF_PLACES: [CheckOfPlaces; 4] = [
    periodic::errors,
    places::errors,
    room::errors,
    reach::errors,
];

/// `spec`, which stands `at` the root of a document, if nothing is wrong with it.
pub(super) fn checked(spec: ScenarioSpec, at: &Place, open: Open) -> Result<Checked, InputErrors> {
    let errors: Vec<InputError> = CHECKS.iter().flat_map(|check| check(&spec, at)).collect();
    let mut of_places = Vec::new();
    let solids = ground::solids(&spec.world, &at.key("world"), open, &mut of_places);
    let areas = ground::areas(&spec.terrain, &at.key("terrain"), &mut of_places);
    if !errors.is_empty() {
        return Err(InputErrors([errors, of_places].concat()));
    }
    let scenario = Scenario::new(&spec, solids, areas);
    let checked = Checked { spec, scenario };
    // What is wrong in a world without the obstacles that are wrong is wrong with them too.
    for check in CHECKS_OF_PLACES {
        let told: BTreeSet<String> = of_places.iter().map(|error| error.path.clone()).collect();
        let more = check(&checked, at).into_iter();
        of_places.extend(more.filter(|error| !told.contains(&error.path)));
    }
    InputErrors::or(of_places, Some(checked))
}

/// The files of obstacles that have not been read.
pub(super) fn files_wanted(spec: &ScenarioSpec, document: &Document) -> Vec<String> {
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
