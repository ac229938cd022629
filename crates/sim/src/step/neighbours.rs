//! Neighbour lists.
//!
//! Each robot has a list of the robots of its layer within its range plus a skin, and of the static
//! geometry there; it stays valid until some robot has moved half the skin (L. Verlet, *Computer
//! "experiments" on classical fluids*, Physical Review 159, 1967). The lists only state where to
//! look: results do not depend on their age, so they are not part of the state of a run.

use crate::scenario::Scenario;
use crate::world::buckets::Buckets;
use crate::world::grid::Still;
use crate::world::static_geometry::StaticGeometry;
use base::geometry::{Disc, Point, Torus};
use brain::AgentId;
use rayon::prelude::*;

/// Robots whose lists are stored together: a task for a thread.
const ROBOTS_PER_PIECE: usize = 1024;

/// Lists of near robots.
#[derive(Debug, Clone)]
pub(crate) struct Neighbours {
    buckets: Buckets,
    pieces: Vec<Piece>,
    /// The farthest that any robot can have moved since the lists were built; infinite before.
    gone_m: f64,
    /// By kind.
    reach_m: Vec<f64>,
    skin_m: f64,
    torus: Option<Torus>,
}

/// The lists of some consecutive robots.
#[derive(Debug, Clone, Default)]
struct Piece {
    /// Where the lists of each robot end: of robots, of separate discs, of overlapping discs, of
    /// walls. They are stored one after the other.
    ends: Vec<[u32; 4]>,
    things: Vec<u32>,
    /// Whether a robot may touch static geometry in the next step.
    may_touch: Vec<bool>,
    /// Robots that may touch each other in the next step, the lower number first; ascending.
    pairs: Vec<[u32; 2]>,
}

/// What may be near a robot, in no particular order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vicinity<'a> {
    pub(crate) robots: &'a [u32],
    /// Static geometry that rays can meet: discs that overlap no other, other discs, and walls.
    pub(crate) discs_apart: &'a [u32],
    pub(crate) discs_overlapping: &'a [u32],
    pub(crate) walls: &'a [u32],
}

impl Neighbours {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let biggest_m = scenario.max_radius_m();
        let kinds = scenario.kinds.iter();
        let reach_m = kinds.map(|kind| {
            let rays_m = if kind.rays_m > 0.0 {
                kind.rays_m + biggest_m
            } else {
                0.0
            };
            rays_m.max(scenario.contact_m)
        });
        let reach_m: Vec<f64> = reach_m.collect();
        // Half as wide as the range: fewer robots are checked in vain.
        let cell_m = f64::midpoint(reach_m.iter().copied().fold(0.0, f64::max), scenario.skin_m);
        Self {
            buckets: Buckets::new(scenario.world.size(), cell_m).on(
                scenario.torus,
                scenario.interaction_range_m() + scenario.skin_m,
            ),
            torus: scenario.torus,
            pieces: Vec::new(),
            gone_m: f64::INFINITY,
            reach_m,
            skin_m: scenario.skin_m,
        }
    }

    /// Notes that no robot has moved farther than this since the last note.
    pub(crate) fn note(&mut self, gone_m: f64) {
        self.gone_m += gone_m;
    }

    /// Rebuilds the lists at the next refresh: robots were added, removed or moved.
    pub(crate) fn forget(&mut self) {
        self.gone_m = f64::INFINITY;
    }

    /// Whether no robot can have moved too far since the lists were built.
    pub(crate) fn are_valid(&self) -> bool {
        2.0 * self.gone_m <= self.skin_m
    }

    /// Rebuilds the lists if they are no longer valid.
    pub(crate) fn refresh(
        &mut self,
        scenario: &Scenario,
        ids: &[AgentId],
        discs: &[Disc],
        is_shared: bool,
    ) {
        if self.are_valid() {
            return;
        }
        self.gone_m = 0.0;
        self.buckets.fill(discs.iter().map(|disc| disc.centre));
        self.pieces
            .resize_with(discs.len().div_ceil(ROBOTS_PER_PIECE), Piece::default);
        let (buckets, reach_m) = (&self.buckets, &self.reach_m[..]);
        let list = |(number, piece): (usize, &mut Piece)| {
            let first = number * ROBOTS_PER_PIECE;
            let robots = first..discs.len().min(first + ROBOTS_PER_PIECE);
            piece.clear();
            for robot in robots {
                piece.add(scenario, (buckets, reach_m), (ids, discs), robot);
            }
        };
        if is_shared {
            self.pieces.par_iter_mut().enumerate().for_each(list);
        } else {
            self.pieces.iter_mut().enumerate().for_each(list);
        }
    }

    /// What is in range of a robot, and possibly some more.
    #[inline]
    pub(crate) fn of(&self, robot: usize) -> Vicinity<'_> {
        let piece = &self.pieces[robot / ROBOTS_PER_PIECE];
        let place = robot % ROBOTS_PER_PIECE;
        let start = place
            .checked_sub(1)
            .map_or(0, |before| piece.ends[before][3]);
        let [robots, apart, overlapping, walls] = piece.ends[place];
        let some = |from: u32, to: u32| &piece.things[from as usize..to as usize];
        Vicinity {
            robots: some(start, robots),
            discs_apart: some(robots, apart),
            discs_overlapping: some(apart, overlapping),
            walls: some(overlapping, walls),
        }
    }

    /// Whether a robot may touch static geometry in the next step.
    #[inline]
    pub(crate) fn may_touch(&self, robot: usize) -> bool {
        self.pieces[robot / ROBOTS_PER_PIECE].may_touch[robot % ROBOTS_PER_PIECE]
    }

    /// Robots that may touch each other in the next step, the lower number first; ascending.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = &[u32; 2]> {
        self.pieces.iter().flat_map(|piece| &piece.pairs)
    }

    /// The place of a robot as seen from another: its nearest image, in a periodic world.
    #[inline]
    pub(crate) fn image(&self, from: Point, place: Point) -> Point {
        self.torus.map_or(place, |torus| torus.image(from, place))
    }

    /// Robots of any layer within a distance of a place, and possibly some more; in no particular
    /// order.
    pub(crate) fn about(&self, place: Point, radius_m: f64) -> impl Iterator<Item = u32> {
        let near = self.buckets.near(place, radius_m + self.skin_m);
        // The image of a robot that was nearest when the lists were built, except for the farthest
        // ones.
        let near = near.filter(move |(image, _)| {
            let torus = self.torus.as_ref();
            torus.is_none_or(|torus| torus.is_nearest(place, *image))
        });
        near.map(|(_, number)| *number)
    }
}

impl Piece {
    fn clear(&mut self) {
        self.ends.clear();
        self.things.clear();
        self.may_touch.clear();
        self.pairs.clear();
    }

    fn add(
        &mut self,
        scenario: &Scenario,
        (buckets, reach_m): (&Buckets, &[f64]),
        (ids, discs): (&[AgentId], &[Disc]),
        robot: usize,
    ) {
        let (id, centre) = (ids[robot], discs[robot].centre);
        let kind = scenario.kind_of(id);
        let skin_m = scenario.skin_m;
        let reach_m = reach_m[usize::from(id.kind)] + skin_m;
        let is_one_layer = scenario.is_one_layer();
        let is_in_layer =
            |other: u32| is_one_layer || scenario.kind_of(ids[other as usize]).layer == kind.layer;
        let near = buckets.near(centre, reach_m);
        let contact_m = scenario.contact_m + skin_m;
        let near = near.map(|(place, other)| (centre.to(*place).length_squared(), *other));
        self.add_robots(near, [reach_m, contact_m], robot, is_in_layer);
        let robots = self.end();
        let touch_m = f64::midpoint(scenario.contact_m, skin_m);
        let nearest_m = if kind.rays_m > 0.0 {
            let reach_m = touch_m.max(kind.rays_m + skin_m / 2.0);
            self.add_seen(scenario.seen(kind.layer), centre, [reach_m, skin_m / 2.0])
        } else {
            self.ends.push([robots; 4]);
            nearest_m(scenario.touched(kind.layer), centre)
        };
        self.may_touch.push(nearest_m < touch_m);
    }

    /// Adds the static geometry that rays can meet to a robot that has its list of robots; returns
    /// the distance of the nearest piece.
    fn add_seen(
        &mut self,
        geometry: &StaticGeometry,
        centre: Point,
        [reach_m, gone_m]: [f64; 2],
    ) -> f64 {
        let mut nearest_m = f64::INFINITY;
        let mut number = |(number, distance_m): (u32, f64)| {
            nearest_m = nearest_m.min(distance_m);
            number
        };
        let robots = self.end();
        let [apart, overlapping] = geometry.discs_within(centre, reach_m);
        self.things.extend(apart.map(&mut number));
        let apart = self.end();
        self.things.extend(overlapping.map(&mut number));
        let overlapping = self.end();
        let faces = geometry.faces_within(centre, reach_m, gone_m);
        self.things.extend(faces.map(&mut number));
        self.ends.push([robots, apart, overlapping, self.end()]);
        nearest_m
    }

    /// Adds the near robots of a layer, given their squared distances.
    ///
    /// Whether one is near is as good as random: it is written in any case.
    fn add_robots(
        &mut self,
        near: impl Iterator<Item = (f64, u32)>,
        [reach_m, contact_m]: [f64; 2],
        robot: usize,
        is_in_layer: impl Fn(u32) -> bool,
    ) {
        let first = self.pairs.len();
        let mut end = self.things.len();
        near.for_each(|(square, other)| {
            let is_near = square < reach_m * reach_m && other as usize != robot;
            if end == self.things.len() {
                self.things.push(0);
            }
            self.things[end] = other;
            end += usize::from(is_near && is_in_layer(other));
            if square < contact_m * contact_m && other as usize > robot && is_in_layer(other) {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "robots have 32-bit numbers"
                )]
                self.pairs.push([robot as u32, other]);
            }
        });
        self.things.truncate(end);
        self.pairs[first..].sort_unstable();
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "robots of a piece have not that many"
    )]
    fn end(&self) -> u32 {
        self.things.len() as u32
    }
}

/// Distance of the nearest static geometry from a place.
fn nearest_m(geometry: &StaticGeometry, place: Point) -> f64 {
    let walls = geometry.walls_near(place).map(|wall| wall.distance(place));
    let discs = geometry
        .discs_near(place)
        .map(|disc| disc.distance_m(place));
    walls.chain(discs).fold(f64::INFINITY, f64::min)
}
