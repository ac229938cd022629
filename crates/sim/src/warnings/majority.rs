//! Warnings about kinds of controllers of which no majority is left, or in range of each other.

use super::economy::owners;
use crate::controllers::ControllerSpec;
use crate::scenario::{Checked, ScenarioSpec};
use base::document::Place;
use base::geometry::Point;
use base::placement::Placement;
use base::warning::Warning;

pub(super) fn warnings(checked: &Checked, at: &Place) -> Vec<Warning> {
    let spec = &checked.spec;
    let has_goals = |name: &String| owners(spec).any(|(owner, _)| owner == name);
    let kinds = spec
        .controllers
        .iter()
        .filter(|(name, kind)| kind.has_voters() && (kind.clearance.is_some() || has_goals(name)));
    let found = kinds.flat_map(|(name, kind)| {
        let at = at.key("controllers").key(name);
        let found = [
            of_two(kind, &at),
            of_failed(kind, &at),
            of_range(kind, spec, &at),
        ];
        found.into_iter().flatten()
    });
    found.collect()
}

/// Two controllers need each other: with one, fewer missions end so.
fn of_two(kind: &ControllerSpec, at: &Place) -> Option<Warning> {
    (kind.count == 2).then(|| {
        let effect = "each needs the vote of the other, so that the loss of either one leaves all goals without an owner: two \
                      are less safe than one, and three survive the loss of one. With backup = \"none\", each loses only \
                      its own goals";
        at.key("count").warning(effect.to_owned())
    })
}

/// No majority is left of those that have not failed from the start.
fn of_failed(kind: &ControllerSpec, at: &Place) -> Option<Warning> {
    let failed = (0..kind.count).filter(|index| kind.failed.contains(index));
    let working = kind.count - u32::try_from(failed.count()).unwrap_or(kind.count);
    (working > 0 && working <= kind.count / 2).then(|| {
        let effect = format!(
            "{working} of {} work, which is no majority: they own no goals",
            kind.count
        );
        at.key("failed").warning(effect)
    })
}

/// Controllers at places from which messages to and from too few others arrive.
fn of_range(kind: &ControllerSpec, spec: &ScenarioSpec, at: &Place) -> Option<Warning> {
    let Some(Placement::Fixed { at_m, .. }) = &kind.start else {
        return None;
    };
    if spec.world.periodic {
        return None;
    }
    let places = at_m.get(..kind.count as usize)?;
    let range_m = kind.radio.range_m;
    let is_near = |one: Point, other: Point| one.to(other).length() <= range_m;
    let near = |place: &Point| places.iter().filter(|it| is_near(*place, **it)).count();
    let alone = places
        .iter()
        .map(near)
        .filter(|near| *near <= places.len() / 2);
    let alone = alone.count();
    (alone > 0).then(|| {
        let all = places.len();
        let which = if alone == all {
            format!("no controller reaches a majority of the {all} of the kind: they own no goals")
        } else {
            format!(
                "{alone} of the {all} controllers do not reach a majority of them, and own no goals"
            )
        };
        let effect = format!("{which}. With backup = \"none\", each owns its goals alone");
        at.key("radio").key("range_m").warning(effect)
    })
}
