//! The partition of a field among the robots of a team that searches it.
//!
//! All robots of a team compute the same partition from their positions and the unobserved area: each
//! gets the blocks nearest to the centroid of the unobserved area in its part (Lloyd, *Least squares
//! quantization in PCM*, 1982; for robots Cortes, Martinez, Karatas and Bullo, *Coverage control for
//! mobile sensing networks*, 2004).

use crate::messaging::peers::{Peer, Peers};
use crate::perception::beliefs::Map;
use crate::perception::beliefs::field::Field;
use alloc::vec::Vec;
use base::geometry::Point;

/// Number of blocks in each direction.
const BLOCKS: usize = 8;

/// Number of iterations.
const ROUNDS: usize = 4;

/// Weight of cells in the parts of other robots.
const OTHERS: f64 = 0.1;

/// A robot's part: blocks of the field.
#[derive(Debug, Clone, Default)]
pub(crate) struct Part {
    /// One bit per block.
    own: u64,
    /// Kept between steps to reuse their allocations: the unobserved area of each block, and the
    /// centroid of each part, the robot's own first.
    left: Vec<f32>,
    centres: Vec<Point>,
}

impl Part {
    /// Computes the partition again.
    pub(crate) fn renew(&mut self, own: Point, peers: &Peers, map: &Map) {
        self.centres.clear();
        self.centres.push(own);
        let mates = peers.mates.iter();
        self.centres.extend(mates.filter_map(Peer::at));
        if self.centres.len() == 1 {
            self.own = u64::MAX;
            return;
        }
        self.sum_up(map);
        for _ in 0..ROUNDS {
            self.move_centres(&map.field);
        }
        self.own = 0;
        for block in 0..BLOCKS * BLOCKS {
            if self.nearest(centre(&map.field, block)) == 0 {
                self.own |= 1 << block;
            }
        }
    }

    /// The weight of a cell for this robot.
    #[inline]
    pub(crate) fn share(&self, field: &Field, cell: usize) -> f64 {
        let is_own = self.own >> block_of(field, cell) & 1 == 1;
        if is_own { 1.0 } else { OTHERS }
    }

    fn sum_up(&mut self, map: &Map) {
        let Map {
            field, coverage, ..
        } = map;
        self.left.clear();
        self.left.resize(BLOCKS * BLOCKS, 0.0);
        for row in 0..field.rows {
            let blocks = row * BLOCKS / field.rows * BLOCKS..;
            let cells = coverage.row(field, row);
            let mut first = 0;
            for (number, left) in self.left[blocks].iter_mut().take(BLOCKS).enumerate() {
                // The first column of the next block.
                let end = ((number + 1) * field.columns).div_ceil(BLOCKS);
                *left += cells[first..end].iter().sum::<f32>();
                first = end;
            }
        }
    }

    /// Moves each centre to the centroid of the unobserved area in its part.
    fn move_centres(&mut self, field: &Field) {
        let mut sums = [(Point::default(), 0.0); MAX_ROBOTS];
        for (block, left) in self.left.iter().enumerate() {
            if *left > 0.0 {
                let (place, left) = (centre(field, block), f64::from(*left));
                let (sum, all) = &mut sums[self.nearest(place)];
                (*sum, *all) = (sum.plus(place.times(left)), *all + left);
            }
        }
        for (middle, (sum, all)) in self.centres.iter_mut().zip(sums) {
            if all > 0.0 {
                *middle = sum.times(1.0 / all);
            }
        }
    }

    /// Index of the centre nearest to a place.
    fn nearest(&self, place: Point) -> usize {
        let mut nearest = (f64::INFINITY, 0);
        for (number, middle) in self.centres.iter().enumerate() {
            let away_m2 = middle.to(place).length_squared();
            if away_m2 < nearest.0 {
                nearest = (away_m2, number);
            }
        }
        nearest.1
    }
}

/// A robot and its maximum number of peers.
const MAX_ROBOTS: usize = 1 + crate::messaging::peers::MAX_PEERS;

#[inline]
fn block_of(field: &Field, cell: usize) -> usize {
    let (column, row) = (cell % field.columns, cell / field.columns);
    row * BLOCKS / field.rows * BLOCKS + column * BLOCKS / field.columns
}

fn centre(field: &Field, block: usize) -> Point {
    let middle = |number: usize, size_m: f64| {
        #[expect(clippy::cast_precision_loss, reason = "at most eight")]
        let share = (number as f64 + 0.5) / BLOCKS as f64;
        share * size_m
    };
    let size = field.size();
    field.place([
        middle(block % BLOCKS, size.x),
        middle(block / BLOCKS, size.y),
    ])
}
