//! What robots can see of a mined lane among obstacles.

use super::checked::Checked;
use super::finders::Finder;
use super::team_reach::Team;
use crate::bodies::RobotSpec;
use crate::controllers::lane::detectors;

/// For each kind of robots, which cells of the lane its detectors can see from where its robots can be; whatever their number,
/// which a study may vary. `None` without a lane, or without obstacles in the world.
pub(super) fn seen(checked: &Checked) -> Option<Vec<Vec<bool>>> {
    let lane = checked.scenario.clearance()?.lane;
    let is_periodic = checked.spec.world.periodic;
    if checked.scenario.solids().is_empty() || is_periodic || !lane.is_valid() {
        return None;
    }
    let robots = checked.spec.robots.values();
    let seen = robots.map(|robot| {
        let finder = finder(robot).into_iter().collect::<Vec<Finder>>();
        let team = Team::new(checked, &finder);
        let cells = 0..lane.cells();
        let is_seen = |cell| team.misses(lane.centre(cell)).is_some();
        cells.map(is_seen).collect()
    });
    Some(seen.collect())
}

/// The range of the item detectors of a kind of robots, if it has any.
fn finder(robot: &RobotSpec) -> Option<Finder<'_>> {
    let range_m = |is_through: bool| {
        let all = detectors(robot);
        let all = all.filter(|(_, items, _)| !is_through || !items.needs_line_of_sight);
        all.map(|(_, items, _)| items.sector.range_m)
            .reduce(f64::max)
    };
    Some(Finder {
        robot,
        range_m: range_m(false)?,
        through_m: range_m(true).unwrap_or(0.0),
    })
}
