//! Checks of vehicles that are to pass a lane.

use crate::passage::PassageSpec;
use crate::scenario::checked::Checked;
use crate::scenario::spec::ScenarioSpec;
use base::document::Place;
use base::error::InputError;

/// Cells of a lane are at most this many times as wide as the path: what lies within it is computed for each cell.
const MAX_CELL_WIDTHS: f64 = 50.0;

pub(super) fn errors(spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let Some(passage) = &spec.passage else {
        return Vec::new();
    };
    let at = root.key("passage");
    if !spec.has_clearance() {
        let allowed = "omitted: without controllers.NAME.clearance, no controllers clear a lane";
        return vec![at.error(allowed)];
    }
    [
        of_lane(passage, spec, root),
        of_hazards(passage, spec, root),
    ]
    .concat()
}

/// A path that is wider than the lane, and cells that are too wide for the path.
fn of_lane(passage: &PassageSpec, spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    for (name, kind) in &spec.controllers {
        let Some(clearance) = &kind.clearance else {
            continue;
        };
        let size = clearance.area(spec).size();
        let lane_m = size.x.min(size.y);
        if passage.width_m > lane_m {
            let allowed = format!("at most {lane_m}: the lane is not wider");
            errors.push(root.key("passage").key("width_m").error(allowed));
        }
        let max_m = MAX_CELL_WIDTHS * passage.width_m;
        if clearance.cell_m > max_m {
            let allowed =
                format!("at most {max_m}: {MAX_CELL_WIDTHS} times the width of the passage");
            let at = root.key("controllers").key(name);
            errors.push(at.key("clearance").key("cell_m").error(allowed));
        }
    }
    errors
}

/// Mines that have no effect on vehicles, and hazards that controllers do not clear.
fn of_hazards(passage: &PassageSpec, spec: &ScenarioSpec, root: &Place) -> Vec<InputError> {
    let mut errors = Vec::new();
    let harmless = spec.items.iter();
    let mut harmless = harmless.filter(|(_, kind)| kind.target && kind.hazard.is_none());
    if let (None, Some((name, _))) = (passage.destroy_probability, harmless.next()) {
        let allowed =
            format!("a number from 0 to 1: items.{name} has no hazard with that probability");
        let at = root.key("passage").key("destroy_probability");
        errors.push(at.error(allowed));
    }
    let unknown = spec.items.iter();
    let unknown = unknown.filter(|(_, kind)| !kind.target && kind.hazard.is_some());
    errors.extend(unknown.map(|(name, _)| {
        let allowed =
            "true: controllers state the risk of vehicles from targets only, and it has a hazard";
        root.key("items").key(name).key("target").error(allowed)
    }));
    errors
}

/// Obstacles that leave no path.
pub(super) fn of_places(checked: &Checked, root: &Place) -> Vec<InputError> {
    let passage = checked.scenario.passage_of(&checked.spec);
    let is_blocked = passage.is_some_and(|passage| !passage.has_room());
    let allowed = "smaller: obstacles leave no path of this width through the lane";
    let at = root.key("passage").key("width_m");
    is_blocked.then(|| at.error(allowed)).into_iter().collect()
}
