//! The place from which the sensors of a robot measure.

use super::view::View;
use crate::bodies::Layer;
use crate::bodies::external::ExternalBody;
use crate::scenario::Scenario;
use crate::sensors::sensor_frame::NoisePurpose;
use base::geometry::Point;
use base::noise::normal_pair;
use base::trig::sin_cos;
use std::f64::consts::TAU;

/// A body whose believed position is inside an obstacle is at the nearest free place of rings around it: the
/// distance of the first ring and the least between two, what each is farther than the one before, and places
/// on each.
const RING_M: f64 = 0.05;
const GROWTH: f64 = 1.02;
const PLACES: u16 = 64;

impl View<'_> {
    /// Where the sensors of a robot measure from: its position. Virtual sensors of an external body measure
    /// from a place that differs from its believed position as the body itself may, but is not behind an
    /// obstacle.
    #[inline]
    pub(super) fn sensing_place(&self, robot: usize) -> Point {
        let at = self.discs[robot].centre;
        if !self.has_external_bodies {
            return at;
        }
        let external = self.body_states[robot].external();
        external.map_or(at, |external| self.likely_place(robot, external))
    }

    /// A place that differs from the believed position of an external body at random.
    #[cold]
    fn likely_place(&self, robot: usize, external: &ExternalBody) -> Point {
        let at = self.discs[robot].centre;
        let kind = self.kind(robot);
        let at = free_place(self.scenario, at, kind.layer);
        let noise = self.noises[robot].words(NoisePurpose::Place as u32, self.tick, 0);
        let [x, y] = normal_pair([noise[0], noise[1]]);
        let error = Point { x, y }.times(external.uncertainty_m(kind.brain.body()));
        let place = at.plus(error);
        let is_free = self.scenario.is_free(place, 0.0, kind.layer);
        let is_open = || self.scenario.hiding([kind.layer; 2]).is_open(at, place);
        if is_free && is_open() { place } else { at }
    }
}

/// About the nearest place in the world to this one that no obstacle covers; this one, if there is none.
fn free_place(scenario: &Scenario, at: Point, layer: Layer) -> Point {
    if scenario.is_free(at, 0.0, layer) {
        return at;
    }
    let world = scenario.world();
    // On the border itself, it would see nothing of that.
    let inside = |at: f64, low: f64, high: f64| at.min(high - RING_M).max(low + RING_M);
    let within = Point {
        x: inside(at.x, world.min().x, world.max().x),
        y: inside(at.y, world.min().y, world.max().y),
    };
    if scenario.is_free(within, 0.0, layer) {
        return within;
    }
    let farthest_m = world.size().length();
    let mut ring_m = RING_M;
    while ring_m < farthest_m {
        let places = (0..PLACES).map(|place| {
            let (y, x) = sin_cos(TAU * f64::from(place) / f64::from(PLACES));
            within.plus(Point { x, y }.times(ring_m))
        });
        if let Some(free) = { places }.find(|place| scenario.is_free(*place, 0.0, layer)) {
            return free;
        }
        ring_m = (ring_m * GROWTH).max(ring_m + RING_M);
    }
    at
}
