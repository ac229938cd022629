//! The path with the lowest expected number of mines within its width, by Dijkstra's algorithm.
//!
//! A move between two neighbouring cells costs what lies in the rectangle between them that is as long as the move and
//! as wide as the path, so that the cost of a straight path is what lies within its width. Moves are to the eight
//! neighbours.

use super::grid::PassageGrid;
use alloc::collections::BinaryHeap;
use alloc::vec;
use alloc::vec::Vec;
use core::cmp::{Ordering, Reverse};

/// Of paths with the same danger, the shortest one nearest to the middle of the lane is chosen: its length costs this
/// share of the danger of the whole lane.
const TIE: f64 = 1e-6;

/// Lowest cost of a whole lane's length: moves are never free.
const MIN_COST: f64 = 1e-15;

const MOVES: [[isize; 2]; 8] = [
    [1, 0],
    [1, 1],
    [1, -1],
    [0, 1],
    [0, -1],
    [-1, 1],
    [-1, -1],
    [-1, 0],
];

/// A search on a grid.
pub(super) struct Search<'s> {
    pub(super) grid: &'s PassageGrid,
    /// Expected mines in each cell.
    pub(super) danger: &'s [f64],
    pub(super) is_free: &'s dyn Fn(usize) -> bool,
    pub(super) width_m: f64,
}

/// A cell that can be reached with a cost.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reached {
    cost: f64,
    cell: usize,
}

impl Eq for Reached {}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost
            .total_cmp(&other.cost)
            .then(self.cell.cmp(&other.cell))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Search<'_> {
    /// The cells of the best path from the first column to the last; `None` if there is none.
    pub(super) fn path(&self) -> Option<Vec<usize>> {
        let cells = self.grid.cells();
        let mut costs = vec![f64::INFINITY; cells];
        let mut before = vec![usize::MAX; cells];
        let mut queue = BinaryHeap::new();
        let tie = self.tie();
        for cell in (0..self.grid.rows).filter(|cell| (self.is_free)(*cell)) {
            costs[cell] = self.band(cell, [0, 1]) / 2.0;
            let cost = costs[cell];
            queue.push(Reverse(Reached { cost, cell }));
        }
        let mut best: Option<Reached> = None;
        while let Some(Reverse(Reached { cost, cell })) = queue.pop() {
            if cost > costs[cell] {
                continue;
            }
            if best.is_some_and(|best| best.cost <= cost) {
                break;
            }
            if cell / self.grid.rows + 1 == self.grid.columns {
                let whole = Reached {
                    cost: cost + self.band(cell, [0, 1]) / 2.0,
                    cell,
                };
                best = Some(best.map_or(whole, |best| best.min(whole)));
            }
            for step in MOVES {
                let Some(next) = self.neighbour(cell, step).filter(|to| (self.is_free)(*to)) else {
                    continue;
                };
                let more = self.between(cell, next, step) + tie * self.length(next, step);
                if cost + more < costs[next] {
                    costs[next] = cost + more;
                    before[next] = cell;
                    let cost = costs[next];
                    queue.push(Reverse(Reached { cost, cell: next }));
                }
            }
        }
        let steps = core::iter::successors(best.map(|best| best.cell), |cell| {
            Some(before[*cell]).filter(|before| *before != usize::MAX)
        });
        let mut path: Vec<usize> = steps.collect();
        path.reverse();
        (!path.is_empty()).then_some(path)
    }

    /// The cost of a metre, which decides between paths with the same danger.
    fn tie(&self) -> f64 {
        let total: f64 = self.danger.iter().sum();
        (TIE * total).max(MIN_COST) / self.grid.length_m()
    }

    /// The length of a move to a cell; longer if it is not in the middle of the lane.
    fn length(&self, to: usize, step: [isize; 2]) -> f64 {
        let [along, across] = step.map(isize::unsigned_abs);
        let length_m = match (along, across) {
            (_, 0) => self.grid.along_m,
            (0, _) => self.grid.across_m,
            _ => self.diagonal_m(),
        };
        length_m * (1.0 + self.grid.off_middle(to))
    }

    fn diagonal_m(&self) -> f64 {
        let [along_m, across_m] = [self.grid.along_m, self.grid.across_m];
        libm::sqrt(along_m * along_m + across_m * across_m)
    }

    /// What lies between two neighbours within the width of the path.
    fn between(&self, from: usize, to: usize, step @ [along, across]: [isize; 2]) -> f64 {
        let aside = match step {
            [_, 0] => [0, 1],
            [0, _] => [1, 0],
            _ => [along, -across],
        };
        let ends = self.band(from, aside) + self.band(to, aside);
        if along == 0 || across == 0 {
            return ends / 2.0;
        }
        // A diagonal move crosses two more cells, and what lies beside them.
        let beside = |first: [isize; 2], sign: isize| {
            let aside = aside.map(|step| sign * step);
            let start = self.neighbour(from, first);
            start.map_or(0.0, |start| self.half_band(start, aside, 0.0))
        };
        ends / 2.0 + beside([along, 0], 1) + beside([0, across], -1)
    }

    /// What lies in a row of cells through a cell, within the width of the path.
    fn band(&self, cell: usize, aside: [isize; 2]) -> f64 {
        let own = (self.width_m / self.step_m(aside)).min(1.0);
        let sides = [aside, aside.map(|step| -step)].into_iter();
        let sides = sides.filter_map(|aside| {
            let next = self.neighbour(cell, aside)?;
            Some(self.half_band(next, aside, 0.5))
        });
        self.danger[cell] * own + sides.sum::<f64>()
    }

    /// The same in a row of cells to one side, whose first cell begins this many cells from the path.
    fn half_band(&self, first: usize, aside: [isize; 2], mut begin: f64) -> f64 {
        let half = self.width_m / 2.0 / self.step_m(aside);
        let (mut sum, mut cell) = (0.0, Some(first));
        while let Some(here) = cell.filter(|_| begin < half) {
            sum += self.danger[here] * (half - begin).min(1.0);
            begin += 1.0;
            cell = self.neighbour(here, aside);
        }
        sum
    }

    fn step_m(&self, aside: [isize; 2]) -> f64 {
        match aside {
            [0, _] => self.grid.across_m,
            [_, 0] => self.grid.along_m,
            _ => self.diagonal_m(),
        }
    }

    fn neighbour(&self, cell: usize, [along, across]: [isize; 2]) -> Option<usize> {
        let (column, row) = (cell / self.grid.rows, cell % self.grid.rows);
        let column = column.checked_add_signed(along)?;
        let row = row.checked_add_signed(across)?;
        let is_inside = column < self.grid.columns && row < self.grid.rows;
        is_inside.then(|| column * self.grid.rows + row)
    }
}
