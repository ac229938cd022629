//! Places the bodies that something outside of the simulation moves.

use super::state::State;
use crate::bodies::external::Read;
use crate::bodies::path::Orientation;
use crate::bodies::region::Region;
use crate::scenario::Scenario;
use base::geometry::Point;

/// Headings beyond this absolute value are ignored.
const MAX_HEADING_RAD: f64 = 1e6;

impl State {
    /// Moves an external body to where it is now, by its percept of this step, if there is one; returns
    /// how far it has moved. Where its pose is not known, its readings are taken as they are.
    pub(crate) fn place_external(&mut self, scenario: &Scenario, robot: usize, read: Read) -> f64 {
        let body = scenario.kind_of(self.ids[robot]).brain.body();
        let body_state = &mut self.body_states[robot];
        let Some(external) = body_state.external_mut() else {
            return 0.0;
        };
        external.observe(read, scenario.step_s, body);
        let percept = read.percept();
        let (at, heading_rad) = match (external.pose, percept) {
            (Some(pose), _) => (Some(pose.at), Some(pose.heading_rad)),
            (None, Some(percept)) => (
                percept.position.map(|reading| reading.value),
                percept.heading_rad.map(|reading| reading.value),
            ),
            (None, None) => (None, None),
        };
        let at = external.last_place().or(at);
        body_state.speed_m_s = external.speed_m_s(body);
        if let Some(heading_rad) = heading_rad.filter(|rad| rad.abs() < MAX_HEADING_RAD) {
            self.orientations[robot] = Orientation::new(heading_rad);
        }
        let is_finite = |at: &Point| at.x.is_finite() && at.y.is_finite();
        let centre = &mut self.discs[robot].centre;
        let before = *centre;
        if let Some(at) = at.filter(is_finite) {
            *centre = scenario.home(at);
        }
        before.to(scenario.image(before, *centre)).length()
    }

    /// Notes where external bodies may be.
    pub(crate) fn note_regions(&mut self, scenario: &Scenario, robots: &[usize]) {
        let of = |robot: &usize| {
            let external = self.body_states[*robot].external()?;
            let kind = scenario.kind_of(self.ids[*robot]);
            let at = self.discs[*robot].centre;
            Some(Region::new(*robot, external, kind, at))
        };
        self.regions = robots.iter().filter_map(of).collect();
    }

    /// How far the centre of a robot may be from its position; 0 if its body is simulated.
    pub(crate) fn uncertainty_m(&self, robot: usize) -> f64 {
        let region = self.regions.iter().find(|region| region.robot == robot);
        region.map_or(0.0, |region| region.uncertainty_m)
    }
}
