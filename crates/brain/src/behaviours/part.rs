//! Which part of a field is a robot's own when a team searches it.
//!
//! All robots of a team draw the parts alike, from where they are and what is left: each has the blocks
//! that are nearest to the middle of what is left in its part (Lloyd, *Least squares quantization in PCM*,
//! 1982; for robots Cortes, Martinez, Karatas and Bullo, *Coverage control for mobile sensing networks*,
//! 2004).

use crate::perception::beliefs::field::Field;
use crate::perception::beliefs::peers::Peer;
use crate::perception::beliefs::{Beliefs, Map};
use alloc::vec::Vec;
use base::geometry::Point;

/// So many blocks each way.
const BLOCKS: usize = 8;

/// Middles are moved so often.
const ROUNDS: usize = 4;

/// What is in another's part counts as much less.
const OTHERS: f64 = 0.1;

/// A robot's part: blocks of the field.
#[derive(Debug, Clone, Default)]
pub(crate) struct Part {
    /// A bit a block.
    own: u64,
    /// Kept so that nothing is allocated: what is left in each block, and the middle of each part, the
    /// robot's own first.
    left: Vec<f32>,
    middles: Vec<Point>,
}

impl Part {
    /// Draws it anew.
    pub(crate) fn renew(&mut self, beliefs: &Beliefs, map: &Map) {
        let Some(pose) = beliefs.pose() else {
            return;
        };
        self.middles.clear();
        self.middles.push(pose.at);
        let mates = beliefs.peers.mates.iter();
        self.middles.extend(mates.filter_map(Peer::at));
        if self.middles.len() == 1 {
            self.own = u64::MAX;
            return;
        }
        self.sum_up(map);
        for _ in 0..ROUNDS {
            self.move_middles(&map.field);
        }
        self.own = 0;
        for block in 0..BLOCKS * BLOCKS {
            if self.nearest(centre(&map.field, block)) == 0 {
                self.own |= 1 << block;
            }
        }
    }

    /// How much of what is in a cell is the robot's own to look for.
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

    /// Moves each middle to the middle of what is left in its part.
    fn move_middles(&mut self, field: &Field) {
        let mut sums = [(Point::default(), 0.0); MOST];
        for (block, left) in self.left.iter().enumerate() {
            if *left > 0.0 {
                let (place, left) = (centre(field, block), f64::from(*left));
                let (sum, all) = &mut sums[self.nearest(place)];
                (*sum, *all) = (sum.plus(place.times(left)), *all + left);
            }
        }
        for (middle, (sum, all)) in self.middles.iter_mut().zip(sums) {
            if all > 0.0 {
                *middle = sum.times(1.0 / all);
            }
        }
    }

    /// Whose middle is nearest to a place.
    fn nearest(&self, place: Point) -> usize {
        let mut nearest = (f64::INFINITY, 0);
        for (number, middle) in self.middles.iter().enumerate() {
            let away_m2 = middle.to(place).length_squared();
            if away_m2 < nearest.0 {
                nearest = (away_m2, number);
            }
        }
        nearest.1
    }
}

/// A robot and all the team mates that it remembers.
const MOST: usize = 1 + crate::perception::beliefs::peers::MAX_PEERS;

#[inline]
fn block_of(field: &Field, cell: usize) -> usize {
    let (column, row) = (cell % field.columns, cell / field.columns);
    row * BLOCKS / field.rows * BLOCKS + column * BLOCKS / field.columns
}

fn centre(field: &Field, block: usize) -> Point {
    let middle = |number: usize, size_m: f64| {
        #[expect(clippy::cast_precision_loss, reason = "eight at most")]
        let share = (number as f64 + 0.5) / BLOCKS as f64;
        share * size_m
    };
    let size = field.size();
    field.place([
        middle(block % BLOCKS, size.x),
        middle(block / BLOCKS, size.y),
    ])
}
