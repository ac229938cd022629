//! What controllers know of the passage of a lane.

use super::PassageSpec;
use crate::scenario::{Scenario, ScenarioSpec};
use crate::world::grid::Still;
use crate::world::items::HazardSpec;
use crate::world::obstacles::Solid;
use base::geometry::{Point, Rectangle, Segment};
use brain::MARK_KINDS;
use economy::{MineEffect, Passage};
use std::sync::Arc;

impl Scenario {
    /// The scenario with the passage of its spec: controllers with a lane plan it.
    pub(crate) fn with_passage(mut self, spec: &ScenarioSpec) -> Self {
        self.passage = spec.passage;
        let Some(passage) = self.passage_of(spec).map(Arc::new) else {
            return self;
        };
        let controllers = self.controllers.iter_mut();
        for kind in controllers.filter(|kind| kind.settings.clearance.is_some()) {
            Arc::make_mut(&mut kind.settings).passage = Some(passage.clone());
        }
        self
    }

    /// The passage of the lane that a spec describes, with the obstacles of the scenario.
    pub(crate) fn passage_of(&self, spec: &ScenarioSpec) -> Option<Passage> {
        let passage = spec.passage?;
        let lane = self.clearance()?.lane;
        let effects = core::array::from_fn(|kind| {
            let item = self.items.get(kind).filter(|item| item.is_target);
            item.map_or_else(MineEffect::default, |item| passage.effect(item.hazard))
        });
        let mut ready = Passage {
            keep_out_m: fence_m(spec),
            effects,
            ..Passage::new(&lane, passage.width_m, passage.vehicles)
        };
        block(&mut ready, self.solids());
        Some(ready)
    }
}

impl PassageSpec {
    /// What a mine with a hazard within the width does to a vehicle.
    pub(crate) fn effect(&self, hazard: Option<HazardSpec>) -> MineEffect {
        let by_hazard = hazard.map_or(0.0, |hazard| hazard.destroy_probability);
        MineEffect {
            destroy_probability: self.destroy_probability.unwrap_or(by_hazard),
            detonates: hazard.is_none_or(|hazard| hazard.detonates),
        }
    }

    /// What an item of a kind of this number does to a vehicle, if it makes the lane unsafe.
    pub(crate) fn effect_of(&self, scenario: &Scenario, kind: u16) -> Option<MineEffect> {
        let number = usize::from(kind);
        let item = &scenario.items[number];
        (item.is_target && number < MARK_KINDS).then(|| self.effect(item.hazard))
    }
}

/// The radius of the largest fence of all robots.
fn fence_m(spec: &ScenarioSpec) -> f64 {
    let robots = spec.robots.values();
    let fences = robots.filter_map(|robot| robot.tools.isolate.as_ref());
    fences.map(|fence| fence.reach_m).fold(0.0, f64::max)
}

/// Blocks the places that are too near to an obstacle.
fn block(passage: &mut Passage, solids: &[Solid]) {
    let Passage {
        grid,
        blocked,
        width_m,
        ..
    } = passage;
    let half_width_m = *width_m / 2.0;
    let mut block = |bounds: Rectangle, is_taken: &dyn Fn(Point) -> bool| {
        for cell in grid.within(&grown(&bounds, half_width_m)) {
            blocked[cell] = blocked[cell] || is_taken(grid.centre(cell));
        }
    };
    for solid in solids {
        let [min, max] = solid.bounds();
        block(Rectangle::spanned(min, max), &|at| solid.covers(at));
        let edges: Vec<Segment> = match solid {
            Solid::Polygon(polygon) => polygon.edges().collect(),
            Solid::Map(map) => map.outline().to_vec(),
            Solid::Disc(disc) => {
                block(Rectangle::spanned(min, max), &|at| {
                    disc.distance_m(at) < half_width_m
                });
                Vec::new()
            }
        };
        for edge in edges {
            block(Rectangle::spanned(edge.from, edge.to), &|at| {
                edge.distance_m(at) < half_width_m
            });
        }
    }
}

fn grown(bounds: &Rectangle, by_m: f64) -> Rectangle {
    let corner = Point { x: by_m, y: by_m };
    Rectangle::spanned(corner.to(bounds.min()), bounds.max().plus(corner))
}
