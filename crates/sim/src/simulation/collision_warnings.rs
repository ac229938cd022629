//! Warnings of imminent collisions, for display only: no brain uses them.

use super::Simulation;
use crate::bodies::body_state::BodyState;
use crate::bodies::path::Orientation;
use base::geometry::Point;

/// A warning is given for a contact within this time, in seconds.
const WITHIN_S: f64 = 1.0;

impl Simulation {
    /// Whether each robot would touch something within a second if it and all others continued
    /// straight at their current speed.
    ///
    /// Static geometry between the path of its centre and those of its sides is not checked: a post
    /// thinner than the robot's radius may be missed.
    pub fn collision_warnings(&mut self) -> Vec<bool> {
        let robots = self.state().robots();
        if self.scenario().is_of_flocks_of_points() {
            return vec![false; robots];
        }
        self.refresh();
        let body_states = self.state().body_states.iter();
        let fastest_m_s = body_states
            .map(|body_state| body_state.speed_m_s.abs())
            .fold(0.0, f64::max);
        let is_warned = |robot: usize| {
            let (body_state, disc) = (&self.state().body_states[robot], &self.state().discs[robot]);
            body_state.speed_m_s != 0.0
                && disc.radius_m > 0.0
                && (self.goes_at_a_wall(robot) || self.goes_at_a_robot(robot, fastest_m_s))
        };
        (0..robots).map(is_warned).collect()
    }

    fn goes_at_a_wall(&self, robot: usize) -> bool {
        let (state, scenario) = (self.state(), self.scenario());
        let disc = &state.discs[robot];
        let layer = scenario.kind_of(state.ids[robot]).layer;
        let geometry = scenario.touched(layer);
        let velocity = velocity(&state.body_states[robot], &state.orientations[robot]);
        let way = velocity.times(WITHIN_S);
        if geometry.is_clear(disc.centre, disc.radius_m + way.length()) {
            return false;
        }
        let ahead = velocity.times(disc.radius_m / velocity.length());
        let aside = Point {
            x: -ahead.y,
            y: ahead.x,
        };
        let middle = [disc.centre, disc.centre.plus(way).plus(ahead)];
        let side = |aside: Point| [disc.centre.plus(aside), disc.centre.plus(way).plus(aside)];
        let ways = [middle, side(aside), side(aside.times(-1.0))];
        ways.iter().any(|[from, to]| !geometry.is_open(*from, *to))
    }

    fn goes_at_a_robot(&self, robot: usize, fastest_m_s: f64) -> bool {
        let (state, scenario) = (self.state(), self.scenario());
        let kind_of = |robot: usize| scenario.kind_of(state.ids[robot]);
        let disc = &state.discs[robot];
        let own = velocity(&state.body_states[robot], &state.orientations[robot]);
        let meet_m = (own.length() + fastest_m_s) * WITHIN_S;
        let reach_m = disc.radius_m + scenario.max_radius_m() + meet_m;
        let mut about = self.neighbours().about(disc.centre, reach_m);
        about.any(|other| {
            let other = other as usize;
            if other == robot || kind_of(other).layer != kind_of(robot).layer {
                return false;
            }
            let its = velocity(&state.body_states[other], &state.orientations[other]);
            let image = scenario.image(disc.centre, state.discs[other].centre);
            let near_m = disc.radius_m + state.discs[other].radius_m;
            will_touch(disc.centre.to(image), own.to(its), near_m)
        })
    }
}

fn velocity(body_state: &BodyState, course: &Orientation) -> Point {
    course.front.times(body_state.speed_m_s)
}

/// Whether something at a place, moving at a constant velocity, comes nearer than `near_m` within a
/// second.
fn will_touch(at: Point, velocity: Point, near_m: f64) -> bool {
    let speed = velocity.length_squared();
    let nearing = -at.dot(velocity);
    let soonest_s = if speed > 0.0 {
        (nearing / speed).clamp(0.0, WITHIN_S)
    } else {
        0.0
    };
    at.plus(velocity.times(soonest_s)).length_squared() < near_m * near_m
}
