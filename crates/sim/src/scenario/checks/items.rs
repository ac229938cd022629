//! Checks of what the keys of a kind of items mean together.

use crate::poisson::MAX_MEAN;
use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;

pub(super) fn errors(spec: &ScenarioSpec, at: &Place) -> Vec<InputError> {
    let drawn = spec.items.iter().filter(|(_, kind)| !kind.is_fixed());
    let too_many = drawn.filter(|(_, kind)| f64::from(kind.count) > MAX_MEAN);
    let errors = too_many.map(|(name, _)| {
        let allowed = format!("a whole number from 0 to {MAX_MEAN} with number = \"poisson\"");
        at.key("items").key(name).key("count").error(allowed)
    });
    errors.collect()
}
