//! What the parts of a scenario mean together; one thing a file.

mod clock;
mod detection;
mod drive;
mod ground;
mod memory;
mod names;
mod places;
mod rates;
mod room;

use super::{Checked, Open, ScenarioSpec};
use base::document::Place;
use base::fault::{Fault, Faults};

/// A check: what is wrong with a scenario that stands `at` the root of a document.
type Check = fn(&ScenarioSpec, &Place) -> Vec<Fault>;

const CHECKS: [Check; 6] = [
    clock::faults,
    names::faults,
    rates::faults,
    drive::faults,
    detection::faults,
    memory::faults,
];

/// A check of what stands where, for a scenario without other faults.
type CheckOfPlaces = fn(&Checked, &Place) -> Vec<Fault>;

const CHECKS_OF_PLACES: [CheckOfPlaces; 2] = [places::faults, room::faults];

/// `spec`, which stands `at` the root of a document, if nothing is wrong with it.
pub(super) fn checked(spec: ScenarioSpec, at: &Place, open: Open) -> Result<Checked, Faults> {
    let mut faults: Vec<Fault> = CHECKS.iter().flat_map(|check| check(&spec, at)).collect();
    let solids = ground::solids(&spec.world, &at.key("world"), open, &mut faults);
    let areas = ground::areas(&spec.terrain, &at.key("terrain"), &mut faults);
    let checked = Checked {
        spec,
        solids,
        areas,
    };
    // Where an obstacle is wrong, what stands in it cannot be said.
    if faults.is_empty() {
        faults.extend(
            CHECKS_OF_PLACES
                .iter()
                .flat_map(|check| check(&checked, at)),
        );
    }
    Faults::or(faults, Some(checked))
}

#[cfg(test)]
mod tests;
