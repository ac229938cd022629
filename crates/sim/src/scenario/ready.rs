//! A scenario converted for runs: checked, in SI units and radians, and with constants computed
//! once.

use super::features::Features;
use super::spec::ScenarioSpec;
use super::world_hash::world_hash;
use crate::agent_clock::AgentClocks;
use crate::bodies::Layer;
use crate::bodies::kind::{Kind, KindContext};
use crate::controllers::kind::ControllerKind;
use crate::end::EndCondition;
use crate::goals::kind::{GoalContext, GoalKind};
use crate::passage::PassageSpec;
use crate::schedule::steps_of;
use crate::world::grid::{NearCells, Still};
use crate::world::item_number::ItemNumber;
use crate::world::items::ItemKind;
use crate::world::obstacles::Solid;
use crate::world::static_geometry::{StaticGeometry, Wall};
use crate::world::terrain::{Area, Terrain, TerrainFactors};
use base::geometry::{Disc, Point, Rectangle, Segment, Torus};
use economy::{Clearance, Settings};
use std::sync::Arc;

/// Neighbour lists reach farther than necessary: by this fraction of the range of rays, but within
/// these limits in metres. They stay valid until a robot has moved half of it.
const SKIN: f64 = 0.2;
const MIN_SKIN_M: f64 = 0.6;
const MAX_SKIN_M: f64 = 2.0;

/// Everything that does not change in a run. Runs share it.
#[derive(Debug, Clone)]
pub struct Scenario {
    pub(crate) step_s: f64,
    pub(crate) time_limit_s: f64,
    /// Steps until the time limit.
    pub(crate) steps: u64,
    pub(crate) world: Rectangle,
    /// The sides of a periodic world; `None` if it has a wall around it.
    pub(crate) torus: Option<Torus>,
    pub(crate) terrain: Option<Terrain>,
    /// A hash of the world with its obstacles and terrain; `None` without any.
    pub(crate) world_hash: Option<u64>,
    /// Obstacles, and what is near them.
    solids: Vec<Solid>,
    /// By obstacle, its index in `world.obstacles`, where one entry may be several of them.
    entries: Vec<usize>,
    near_solids: NearCells,
    /// By layer: what rays meet, and what bodies collide with.
    seen: [StaticGeometry; 2],
    touched: [StaticGeometry; 2],
    pub(crate) items: Vec<ItemKind>,
    /// The condition with which a run is complete: that of the scenario, otherwise that all targets are found
    /// and all goals are served; `None` if there are none of them either.
    pub(crate) end: Option<EndCondition>,
    pub(crate) kinds: Vec<Kind>,
    /// Kinds of controllers; ids number them after the kinds of robots.
    pub(crate) controllers: Vec<ControllerKind>,
    pub(crate) goals: Vec<GoalKind>,
    /// Vehicles that are to pass the lane.
    pub(crate) passage: Option<PassageSpec>,
    pub(crate) clocks: AgentClocks,
    /// Whether robots or controllers fail at random times.
    pub(crate) has_failures: bool,
    /// Whether anything can happen to items besides detections, in any configuration of the study.
    pub(crate) has_acts: bool,
    /// Two robots farther apart than this, from centre to centre, cannot touch in one step.
    pub(crate) contact_m: f64,
    /// Additional reach of neighbour lists.
    pub(crate) skin_m: f64,
}

impl Scenario {
    /// A gap smaller than this, in metres, is a contact by rounding.
    pub(crate) const TOLERANCE_M: f64 = 1e-9;

    /// The scenario that a checked spec describes, with its obstacles and terrain areas as they
    /// were read; later areas override earlier ones.
    #[must_use]
    pub fn new(spec: &ScenarioSpec, solids: Vec<Solid>, areas: Vec<Area>) -> Self {
        let step_s = spec.clock.step_s;
        let [width, height] = spec.world.size_m;
        let size_m = Point {
            x: width.0,
            y: height.0,
        };
        let items: Vec<ItemKind> = spec.items.iter().map(ItemKind::new).collect();
        let names: Vec<String> = items.iter().map(|kind| kind.name.clone()).collect();
        let hazards_m: Vec<Option<f64>> = items.iter().map(ItemKind::hazard_m).collect();
        let world = Rectangle::spanned(Point::default(), size_m);
        let capabilities = spec.capabilities();
        let context = KindContext {
            item_kinds: &names,
            hazards_m: &hazards_m,
            robots: &spec.robots,
            capabilities: &capabilities,
            field: world,
            step_s,
        };
        let kinds = spec.robots.iter();
        let mut kinds: Vec<Kind> = kinds
            .map(|(name, spec)| Kind::new(name, spec, &context))
            .collect();
        if spec.world.periodic && solids.is_empty() {
            for kind in &mut kinds {
                kind.flocking = kind.as_flock();
            }
        }
        let fastest = areas.iter().map(Area::speed).fold(1.0, f64::max);
        let touch_m = greatest(&kinds, |kind| kind.touch_m(fastest * step_s));
        let rays_m = greatest(&kinds, |kind| kind.rays_m);
        let skin_m = (SKIN * rays_m).clamp(MIN_SKIN_M, MAX_SKIN_M);
        let torus = spec.world.periodic.then_some(Torus { size_m });
        let geometry = |layer, reach_m| {
            let border = torus.is_none().then_some(&world);
            let (walls, discs) = in_the_way(border, &solids, layer);
            let reach_m = reach_m + skin_m / 2.0;
            match torus {
                Some(torus) => StaticGeometry::on(torus, &walls, &discs, reach_m),
                None => StaticGeometry::new(size_m, &walls, &discs, reach_m),
            }
        };
        let layers = [Layer::Ground, Layer::Air];
        let near_solids = NearCells::new(size_m, &solids, 0.0);
        let is_covered = |place| is_covered(&solids, &near_solids, place);
        let is_covered: &dyn Fn(Point) -> bool = &is_covered;
        let controllers = controllers(spec, (!solids.is_empty()).then_some(is_covered));
        let scenario = Self {
            step_s,
            time_limit_s: spec.clock.time_limit_s,
            steps: steps_of(spec.clock.time_limit_s, step_s),
            world,
            torus,
            world_hash: world_hash((&world, torus.as_ref()), &solids, &areas),
            terrain: (!areas.is_empty()).then(|| Terrain::new(size_m, areas)),
            near_solids,
            seen: layers.map(|layer| geometry(layer, rays_m.max(touch_m))),
            touched: layers.map(|layer| geometry(layer, touch_m)),
            contact_m: 2.0 * touch_m,
            skin_m,
            entries: entries(spec, solids.len()),
            solids,
            end: end_of(spec, &items),
            items,
            controllers,
            goals: goals(spec, &capabilities),
            clocks: AgentClocks {
                max_offset_s: spec.clock.max_offset_s,
                max_drift: spec.clock.max_drift,
            },
            has_failures: spec.has_failures(),
            has_acts: false,
            passage: None,
            kinds,
        };
        scenario.with_passage(spec)
    }

    /// The obstacles on the ground.
    #[must_use]
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// The same, each with its index in `world.obstacles`.
    pub fn obstacles(&self) -> impl Iterator<Item = (usize, &Solid)> {
        self.entries.iter().copied().zip(&self.solids)
    }

    /// Number of robots of all kinds.
    #[must_use]
    pub fn robots(&self) -> usize {
        self.kinds.iter().map(|kind| kind.count as usize).sum()
    }

    pub(crate) fn max_radius_m(&self) -> f64 {
        greatest(&self.kinds, |kind| kind.radius_m)
    }

    /// Whether nothing can be touched or detected: all robots are points that only flock.
    pub(crate) fn is_of_flocks_of_points(&self) -> bool {
        let is_one = |kind: &Kind| kind.flocking.is_some() && kind.radius_m == 0.0;
        self.kinds.iter().all(is_one) && self.controllers.is_empty() && self.goals.is_empty()
    }

    /// Whether all robots can be in each other's way.
    #[inline]
    pub(crate) fn is_one_layer(&self) -> bool {
        self.kinds
            .windows(2)
            .all(|pair| pair[0].layer == pair[1].layer)
    }

    /// The lane that controllers are to clear, if there is one.
    pub(crate) fn clearance(&self) -> Option<&Clearance> {
        let mut controllers = self.controllers.iter();
        controllers.find_map(|kind| kind.settings.clearance.as_deref())
    }

    /// The scenario with what the detectors of each kind of robots can see of the lane.
    pub(super) fn with_seen(mut self, seen: &[Vec<bool>]) -> Self {
        for kind in &mut self.controllers {
            let Some(clearance) = kind.settings.clearance.as_deref() else {
                continue;
            };
            let mut clearance = clearance.clone();
            for (robot, seen) in clearance.robots.iter_mut().zip(seen) {
                robot.seen.clone_from(seen);
            }
            kind.settings = Arc::new(Settings {
                clearance: Some(Arc::new(clearance)),
                ..(*kind.settings).clone()
            });
        }
        self
    }

    /// The largest number of targets in a run.
    pub(crate) fn max_targets(&self) -> u32 {
        self.sum_of_targets(|kind| self.items[kind].max_number())
    }

    /// Whether runs can begin with any number of items of a kind.
    pub(crate) fn draws_item_numbers(&self) -> bool {
        self.items
            .iter()
            .any(|kind| kind.number != ItemNumber::Fixed)
    }

    /// The sum of a number of each kind of items, over the kinds that are targets.
    pub(crate) fn sum_of_targets(&self, number: impl Fn(usize) -> u32) -> u32 {
        let kinds = self.items.iter().enumerate();
        let targets = kinds.filter(|(_, kind)| kind.is_target);
        targets.map(|(kind, _)| number(kind)).sum()
    }

    /// The largest distance at which anything detects items or acts on them.
    pub(crate) fn items_reach_m(&self) -> f64 {
        let acts_m = greatest(&self.kinds, Kind::acts_reach_m);
        let hazard_m = self
            .max_hazard_m()
            .map_or(0.0, |hazard_m| hazard_m + self.max_radius_m());
        greatest(&self.kinds, Kind::items_reach_m)
            .max(acts_m)
            .max(hazard_m)
    }

    /// The largest distance from a robot at which an item can destroy it; `None` if none can.
    pub(crate) fn max_hazard_m(&self) -> Option<f64> {
        let hazards = self.items.iter().filter_map(|kind| kind.hazard);
        hazards.map(|hazard| hazard.radius_m).reduce(f64::max)
    }

    /// Length of a time step.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// The time limit of a run.
    #[must_use]
    pub fn time_limit_s(&self) -> f64 {
        self.time_limit_s
    }

    /// Maximum offset of the clocks of robots and controllers.
    #[must_use]
    pub fn max_clock_offset_s(&self) -> f64 {
        self.clocks.max_offset_s
    }

    /// Maximum drift of the clocks of robots and controllers.
    #[must_use]
    pub fn max_clock_drift(&self) -> f64 {
        self.clocks.max_drift
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> Rectangle {
        self.world
    }

    /// Whether the world is periodic.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.torus.is_some()
    }

    /// What rays meet in a layer.
    #[inline]
    pub(crate) fn seen(&self, layer: Layer) -> &StaticGeometry {
        &self.seen[layer as usize]
    }

    /// What bodies of a layer collide with.
    #[inline]
    pub(crate) fn touched(&self, layer: Layer) -> &StaticGeometry {
        &self.touched[layer as usize]
    }

    /// The effect of the terrain on a robot of a layer.
    #[inline]
    pub(crate) fn terrain_factors(&self, place: Point, layer: Layer) -> TerrainFactors {
        match &self.terrain {
            Some(terrain) if layer == Layer::Ground => terrain.at(place),
            _ => TerrainFactors::NO_EFFECT,
        }
    }

    /// What hides things of two layers from each other: everything on the ground, unless both fly.
    #[inline]
    pub(crate) fn hiding(&self, layers: [Layer; 2]) -> &StaticGeometry {
        let [one, other] = layers;
        self.touched(if one == other { one } else { Layer::Ground })
    }

    /// The largest factor on speed anywhere, at least 1.
    pub(crate) fn max_speed_factor(&self) -> f64 {
        let terrain = self.terrain.as_ref();
        terrain.map_or(1.0, |terrain| terrain.most().speed)
    }

    /// A place in the world: in a periodic world, where a robot that leaves it enters again.
    #[inline]
    pub(crate) fn home(&self, place: Point) -> Point {
        self.torus.map_or(place, |torus| torus.home(place))
    }

    /// A place as seen from another: its nearest image, in a periodic world.
    #[inline]
    pub(crate) fn image(&self, from: Point, place: Point) -> Point {
        self.torus.map_or(place, |torus| torus.image(from, place))
    }

    /// Whether a place is in the world; a periodic world has no border.
    pub(crate) fn has_place(&self, place: Point) -> bool {
        self.torus.is_some() || self.world.contains(place)
    }

    /// No robot touches, detects or receives another whose nearest image is farther away.
    pub(crate) fn interaction_range_m(&self) -> f64 {
        let rays_m = greatest(&self.kinds, |kind| kind.rays_m) + self.max_radius_m();
        let observed_m = greatest(&self.kinds, Kind::robots_reach_m);
        let size_m = self.world.size();
        let observed_m = observed_m.min(size_m.x.max(size_m.y) / 2.0);
        rays_m.max(observed_m).max(self.contact_m)
    }

    /// Whether a disc of a layer fits into a place.
    pub(crate) fn is_free(&self, place: Point, radius_m: f64, layer: Layer) -> bool {
        let corner = Point {
            x: radius_m,
            y: radius_m,
        };
        let is_inside = match self.torus {
            Some(_) => self.world.contains(place),
            None => {
                self.world.contains(corner.to(place)) && self.world.contains(place.plus(corner))
            }
        };
        let touched = self.touched(layer);
        let clear_m = radius_m - Self::TOLERANCE_M;
        is_inside
            && touched
                .walls_near(place)
                .all(|wall| wall.distance(place) >= clear_m)
            && touched
                .discs_near(place)
                .all(|disc| disc.distance(place) >= clear_m)
            && !(layer == Layer::Ground && self.is_covered(place))
    }

    fn is_covered(&self, place: Point) -> bool {
        is_covered(&self.solids, &self.near_solids, place)
    }
}

/// Whether an obstacle covers a place in the world.
fn is_covered(solids: &[Solid], near: &NearCells, place: Point) -> bool {
    let mut near = near.at(place).iter();
    near.any(|number| solids[*number as usize].covers(place))
}

/// By obstacle, its index in `world.obstacles` of a valid spec. An invalid one may have more copies than
/// fit into memory.
fn entries(spec: &ScenarioSpec, obstacles: usize) -> Vec<usize> {
    let entries = spec.world.obstacles.iter().enumerate();
    let copies =
        entries.flat_map(|(index, obstacle)| std::iter::repeat_n(index, obstacle.repeat().count()));
    copies.take(obstacles).collect()
}

fn end_of(spec: &ScenarioSpec, items: &[ItemKind]) -> Option<EndCondition> {
    let Some(end) = &spec.end else {
        if spec.has_clearance() {
            return Some(EndCondition::declared());
        }
        let has_targets = items.iter().any(|kind| kind.is_target && kind.count > 0);
        let has_goals = spec.goals.values().any(|kind| kind.count > 0);
        let is_plain = items.iter().all(ItemKind::is_only_found);
        let all_found = has_targets.then(|| EndCondition::all_complete(is_plain));
        return if has_goals {
            Some(EndCondition::all_served(is_plain))
        } else {
            all_found
        };
    };
    let items = spec.items.keys().map(String::as_str);
    let has = Features {
        goals: !spec.goals.is_empty(),
        acts: true,
        clearance: spec.has_clearance(),
        passage: spec.passage.is_some(),
    };
    EndCondition::parse(&end.when, items, has).ok()
}

fn controllers(
    spec: &ScenarioSpec,
    is_covered: Option<&dyn Fn(Point) -> bool>,
) -> Vec<ControllerKind> {
    let kinds = spec.controllers.iter();
    kinds
        .map(|kind| ControllerKind::new(kind, spec, is_covered))
        .collect()
}

fn goals(spec: &ScenarioSpec, capabilities: &[String]) -> Vec<GoalKind> {
    let controllers: Vec<String> = spec.controllers.keys().cloned().collect();
    let context = GoalContext {
        capabilities,
        controllers: &controllers,
        step_s: spec.clock.step_s,
    };
    let kinds = spec.goals.iter();
    kinds.map(|kind| GoalKind::new(kind, &context)).collect()
}

fn greatest(kinds: &[Kind], value: impl Fn(&Kind) -> f64) -> f64 {
    kinds.iter().map(value).fold(0.0, f64::max)
}

fn in_the_way(
    border: Option<&Rectangle>,
    solids: &[Solid],
    layer: Layer,
) -> (Vec<Wall>, Vec<Disc>) {
    let mut segments: Vec<Segment> = border.map_or(Vec::new(), |border| border.room().to_vec());
    let mut discs = Vec::new();
    if layer == Layer::Ground {
        for solid in solids {
            match solid {
                Solid::Polygon(polygon) => segments.extend(polygon.edges()),
                Solid::Disc(disc) => discs.push(*disc),
                Solid::Map(map) => segments.extend(map.outline()),
            }
        }
    }
    (segments.iter().filter_map(Wall::of).collect(), discs)
}
