//! Warnings about radios that send too few messages per step for the leases of controllers.

use super::economy::owner_of;
use crate::controllers::ControllerSpec;
use crate::scenario::{Checked, ScenarioSpec};
use base::document::Place;
use base::warning::Warning;
use economy::RENEWAL_RETRY_S;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    // A controller that owns its goals alone renews no leases.
    let kinds = spec
        .controllers
        .iter()
        .filter(|(_, kind)| kind.has_voters());
    let found = kinds.filter_map(|(name, kind)| {
        let at = at.key("controllers").key(name);
        of_controllers((name, kind), spec, &at)
    });
    found.collect()
}

/// A kind whose controllers cannot renew the lease of each goal within the time that it lasts.
fn of_controllers(
    (name, kind): (&String, &ControllerSpec),
    spec: &ScenarioSpec,
    at: &Place,
) -> Option<Warning> {
    let goals = spec.goals.values();
    let owned = goals.filter(|goal| owner_of(goal, spec) == Some(name));
    let owned: u32 = owned.map(|goal| goal.count).sum();
    let each = owned.div_ceil(kind.count.max(1)).min(kind.max_goals);
    let needed = (f64::from(each) * RENEWAL_RETRY_S / kind.owner_lease_s).ceil();
    (kind.count > 0 && needed > kind.radio.messages_per_step.into()).then(|| {
        let effect = format!(
            "fewer than the {needed} that {each} goals of a controller need: ownership leases may end before they are \
             renewed, and their goals are lost"
        );
        at.key("radio").key("messages_per_step").warning(effect)
    })
}
