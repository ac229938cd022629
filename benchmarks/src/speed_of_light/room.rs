//! Scratch memory for one step.

use super::rays::{NearDisc, NearWall, Rays, directions};
use base::geometry::Point;
use base::noise::Noise;
use base::random::Entity;

/// Scratch memory for one step.
pub(super) struct Room {
    pub(super) directions: [Rays; 2],
    /// Scratch list; only the first `disc_count` entries are valid.
    pub(super) discs: Vec<NearDisc>,
    pub(super) disc_count: usize,
    pub(super) walls: Vec<NearWall>,
    pub(super) wall_count: usize,
    pub(super) hits: Vec<u32>,
    pub(super) next: Vec<Point>,
    pub(super) noise: Noise,
}

impl Default for Room {
    fn default() -> Self {
        Self {
            directions: directions(),
            discs: Vec::new(),
            disc_count: 0,
            walls: Vec::new(),
            wall_count: 0,
            hits: Vec::new(),
            next: Vec::new(),
            noise: Noise::of(0, 0, Entity { kind: 0, index: 0 }),
        }
    }
}
