//! What the sensors of a robot can query in the world.

use super::view::View;
use crate::clock::seconds;
use crate::sensors::rays::Near;
use crate::sensors::scene::{Other, Scene};
use crate::world::items::Items;
use crate::world::static_geometry::Wall;
use base::geometry::{Disc, Point};

/// The world around a robot at the beginning of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RobotScene<'a> {
    pub(crate) view: &'a View<'a>,
    pub(crate) robot: usize,
    /// The place from which it senses.
    pub(crate) at: Point,
}

impl Scene for RobotScene<'_> {
    fn time_s(&self) -> f64 {
        seconds(self.view.tick, self.view.scenario.step_s)
    }

    #[inline]
    fn heading_rad(&self) -> f64 {
        self.view.orientations[self.robot].heading_rad
    }

    fn items(&self) -> &Items {
        self.view.items
    }

    fn contains(&self, place: Point) -> bool {
        self.view.scenario.has_place(place)
    }

    #[inline]
    fn gather(&self, near: &mut Near) {
        if !self.view.has_external_bodies {
            gather(self.view, self.robot, near);
            return;
        }
        if self.view.body_states[self.robot].is_external() {
            gather_around(self, near);
        } else {
            gather(self.view, self.robot, near);
        }
        gather_regions(self, near);
    }

    fn others_within(&self, range_m: f64, to: &mut Vec<u32>) {
        let about = self.view.neighbours.about(self.at, range_m);
        to.clear();
        to.extend(about.filter(|other| *other as usize != self.robot));
        if self.view.has_external_bodies {
            self.add_silent(to);
        }
        // Lists of near robots have no particular order.
        to.sort_unstable();
        to.dedup();
    }

    fn is_clear(&self, range_m: f64, others: &[u32]) -> bool {
        let scenario = self.view.scenario;
        let Some(first) = others.first().filter(|_| scenario.is_one_layer()) else {
            return false;
        };
        let layers = [self.robot, *first as usize].map(|robot| self.view.kind(robot).layer);
        scenario.hiding(layers).is_clear(self.at, range_m)
    }

    #[inline]
    fn other(&self, number: u32) -> Other<'_> {
        let (view, other) = (self.view, number as usize);
        let layers = [self.robot, other].map(|robot| view.kind(robot).layer);
        let id = view.ids[other];
        let at = view.scenario.image(self.at, view.discs[other].centre);
        let region = view.regions.iter().find(|region| region.robot == other);
        let (at, uncertainty_m) =
            region.map_or((at, 0.0), |region| region.detected_from(self.at, at));
        Other {
            id,
            key: view.kind(other).entity(id.index),
            at,
            uncertainty_m,
            geometry: view.scenario.hiding(layers),
        }
    }

    #[inline]
    fn heading_rad_of(&self, number: u32) -> f64 {
        self.view.orientations[number as usize].heading_rad
    }
}

impl RobotScene<'_> {
    /// Adds the silent robots, which may be nearer than their positions.
    fn add_silent(&self, to: &mut Vec<u32>) {
        let silent = self.view.regions.iter();
        let silent = silent.filter(|region| region.is_silent() && region.robot != self.robot);
        to.extend(silent.filter_map(|region| u32::try_from(region.robot).ok()));
    }
}

/// Fills `near` with what the rays of a robot can meet.
#[inline]
fn gather<'v>(view: &View<'v>, robot: usize, near: &mut Near) {
    let kind = view.kind(robot);
    let geometry = view.scenario.seen(kind.layer);
    let vicinity = view.neighbours.of(robot);
    let at = view.discs[robot].centre;
    near.begin(at, kind.rays_m);
    let bodies = vicinity.robots.iter();
    let bodies = bodies.map(|other| body_from(view, at, *other as usize));
    // An external body may be where another robot is; simulated ones never are.
    if view.has_external_bodies {
        near.take_overlapping(bodies);
    } else {
        near.take_apart(bodies);
    }
    let discs = |numbers: &'v [u32]| numbers.iter().map(|number| *geometry.disc(*number));
    near.take_apart(discs(vicinity.discs_apart));
    near.take_overlapping(discs(vicinity.discs_overlapping));
    near.take_walls(vicinity.walls.iter().map(|number| geometry.wall(*number)));
}

/// The body of a robot as seen from a place.
#[inline]
fn body_from(view: &View, at: Point, robot: usize) -> Disc {
    let body = view.discs[robot];
    Disc {
        centre: view.scenario.image(at, body.centre),
        ..body
    }
}

/// The same for a robot that senses from elsewhere than its lists are made for.
fn gather_around(scene: &RobotScene, near: &mut Near) {
    let RobotScene { view, robot, at } = *scene;
    let (scenario, kind) = (view.scenario, view.kind(robot));
    let geometry = scenario.seen(kind.layer);
    near.begin(at, kind.rays_m);
    let about = view
        .neighbours
        .about(at, kind.rays_m + scenario.max_radius_m());
    let others = about.map(|other| other as usize);
    let others = others.filter(|other| *other != robot && view.kind(*other).layer == kind.layer);
    let bodies: Vec<Disc> = others.map(|other| body_from(view, at, other)).collect();
    near.take_overlapping(bodies.into_iter());
    for discs in geometry.discs_within(at, kind.rays_m) {
        let discs: Vec<Disc> = discs.map(|(number, _)| *geometry.disc(number)).collect();
        near.take_overlapping(discs.into_iter());
    }
    let walls = geometry.faces_within(at, kind.rays_m, 0.0);
    let walls: Vec<&Wall> = walls.map(|(number, _)| geometry.wall(number)).collect();
    near.take_walls(walls.into_iter());
}

/// Adds where other external bodies of its layer may be.
fn gather_regions(scene: &RobotScene, near: &mut Near) {
    let RobotScene { view, robot, at } = *scene;
    let layer = view.kind(robot).layer;
    let others = view.regions.iter();
    let others =
        others.filter(|region| region.robot != robot && view.kind(region.robot).layer == layer);
    for region in others {
        let (mut discs, walls) = region.seen_from(at);
        for disc in &mut discs {
            disc.centre = view.scenario.image(at, disc.centre);
        }
        near.take_overlapping(discs.into_iter());
        near.take_walls(walls.iter());
    }
}
