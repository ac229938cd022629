//! Contacts of external bodies, whose percepts place them whatever else is there.

use super::tick::StepScratch;
use crate::run::state::State;
use crate::scenario::Scenario;
use base::geometry::Disc;

/// A contact begins when two bodies overlap by this number of standard deviations of their positions,
/// and ends when they are apart by as many.
const DEVIATIONS: f64 = 2.0;

impl StepScratch {
    /// Counts a collision of each external body that begins to overlap an obstacle or another body;
    /// returns their number.
    pub(super) fn touch_external(&self, scenario: &Scenario, state: &mut State) -> u64 {
        let mut collisions = 0;
        for robot in self.external.iter().copied() {
            let touches = self.touches(scenario, state, robot);
            let body_state = &mut state.body_states[robot];
            let Some(external) = body_state.external_mut() else {
                continue;
            };
            let was_in_contact = std::mem::replace(&mut external.is_in_contact, touches);
            body_state.is_pressed |= touches;
            if touches && !was_in_contact {
                body_state.collide(scenario.kind_of(state.ids[robot]), state.tick);
                collisions += 1;
            }
        }
        collisions
    }

    /// Whether a body overlaps an obstacle, the border of the world or another body, as far as their
    /// positions are known.
    fn touches(&self, scenario: &Scenario, state: &State, robot: usize) -> bool {
        let kind = scenario.kind_of(state.ids[robot]);
        let external = state.body_states[robot].external();
        let is_in_contact = external.is_some_and(|external| external.is_in_contact);
        let deviations = if is_in_contact {
            -DEVIATIONS
        } else {
            DEVIATIONS
        };
        let own_m = deviation_m(scenario, state, robot);
        let body = Disc {
            radius_m: (kind.radius_m - deviations * own_m).max(0.0),
            ..state.discs[robot]
        };
        if !scenario.is_free(body.centre, body.radius_m, kind.layer) {
            return true;
        }
        let reach_m = kind.radius_m + scenario.max_radius_m() + DEVIATIONS * own_m;
        let mut others = self.neighbours.about(body.centre, reach_m);
        others.any(|other| {
            let other = other as usize;
            let disc = state.discs[other];
            let uncertain_m = own_m.hypot(deviation_m(scenario, state, other));
            let touch_m = kind.radius_m + disc.radius_m - deviations * uncertain_m;
            let way = body.centre.to(scenario.image(body.centre, disc.centre));
            other != robot
                && scenario.kind_of(state.ids[other]).layer == kind.layer
                && way.length() < touch_m - Scenario::TOLERANCE_M
        })
    }
}

/// The standard deviation of the position of a body; 0 for one that is simulated.
fn deviation_m(scenario: &Scenario, state: &State, robot: usize) -> f64 {
    let body = scenario.kind_of(state.ids[robot]).brain.body();
    let external = state.body_states[robot].external();
    external.map_or(0.0, |external| external.uncertainty_m(body))
}
