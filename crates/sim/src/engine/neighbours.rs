//! Which robots are near which.
//!
//! Each robot has a list of the robots of its layer that are within its reach and a skin; it holds
//! until some robot has gone half the skin. The lists only say where to look: what is made of them
//! does not depend on their age, so they are no part of a run's state.

use crate::scenario::Scenario;
use crate::world::buckets::Buckets;
use base::geometry::{Disc, Point};
use brain::RobotId;
use rayon::prelude::*;

/// Lists are made with so much more reach than is needed, in metres.
const SKIN_M: f64 = 0.6;

/// Robots whose lists are in one piece: a task for a thread.
const ROBOTS_PER_PIECE: usize = 1024;

/// Lists of near robots.
#[derive(Debug, Clone)]
pub(crate) struct Neighbours {
    buckets: Buckets,
    pieces: Vec<Piece>,
    /// The farthest that any robot can have gone since the lists were made; infinite before.
    gone_m: f64,
    /// By kind.
    reach_m: Vec<f64>,
}

#[derive(Debug, Clone, Default)]
struct Piece {
    /// Where each robot's list ends.
    ends: Vec<u32>,
    near: Vec<u32>,
}

impl Neighbours {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let biggest_m = scenario.biggest_radius_m();
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
        let cell_m = reach_m.iter().copied().fold(0.0, f64::max) + SKIN_M;
        Self {
            buckets: Buckets::new(scenario.world.size(), cell_m),
            pieces: Vec::new(),
            gone_m: f64::INFINITY,
            reach_m,
        }
    }

    /// Notes that no robot has gone farther than this since the last note.
    pub(crate) fn note(&mut self, gone_m: f64) {
        self.gone_m += gone_m;
    }

    /// Makes the lists anew at the next refresh: robots have come, gone, or been put elsewhere.
    pub(crate) fn forget(&mut self) {
        self.gone_m = f64::INFINITY;
    }

    /// Sees to it that the lists hold now.
    pub(crate) fn refresh(
        &mut self,
        scenario: &Scenario,
        ids: &[RobotId],
        discs: &[Disc],
        is_shared: bool,
    ) {
        if 2.0 * self.gone_m <= SKIN_M {
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
            piece.ends.clear();
            piece.near.clear();
            for robot in robots {
                piece.add(scenario, buckets, reach_m, (ids, discs), robot);
            }
        };
        if is_shared {
            self.pieces.par_iter_mut().enumerate().for_each(list);
        } else {
            self.pieces.iter_mut().enumerate().for_each(list);
        }
    }

    /// Robots in reach of one, and maybe some more; not in any order.
    #[inline]
    pub(crate) fn of(&self, robot: usize) -> &[u32] {
        let piece = &self.pieces[robot / ROBOTS_PER_PIECE];
        let place = robot % ROBOTS_PER_PIECE;
        let start = place.checked_sub(1).map_or(0, |before| piece.ends[before]);
        &piece.near[start as usize..piece.ends[place] as usize]
    }

    /// Robots of any layer within a distance of a place, and maybe some more; not in any order.
    pub(crate) fn about(&self, place: Point, radius_m: f64) -> impl Iterator<Item = u32> {
        self.buckets
            .near(place, radius_m + SKIN_M)
            .map(|(_, number)| *number)
    }
}

impl Piece {
    fn add(
        &mut self,
        scenario: &Scenario,
        buckets: &Buckets,
        reach_m: &[f64],
        (ids, discs): (&[RobotId], &[Disc]),
        robot: usize,
    ) {
        let kind = usize::from(ids[robot].kind);
        let reach_m = reach_m[kind] + SKIN_M;
        let centre = discs[robot].centre;
        let is_one_layer = scenario.is_one_layer();
        let layer = scenario.kinds[kind].layer;
        for (place, other) in buckets.near(centre, reach_m) {
            let is_near = centre.to(*place).length_squared() < reach_m * reach_m;
            if is_near && *other as usize != robot {
                let other_kind = usize::from(ids[*other as usize].kind);
                if is_one_layer || scenario.kinds[other_kind].layer == layer {
                    self.near.push(*other);
                }
            }
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "robots of a piece have not that many"
        )]
        self.ends.push(self.near.len() as u32);
    }
}
