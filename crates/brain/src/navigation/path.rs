//! The shortest path around known obstacles.
//!
//! A wavefront expands from the goal over all cells that the robot fits into (Dijkstra, *A note on
//! two problems in connexion with graphs*, 1959, with integer costs: 5 for a straight step, 7 for a
//! diagonal one). The robot descends the resulting distances, and cuts corners as far as the
//! straight line is free. Unknown cells count as free.
//!
//! A start or goal where the robot does not fit, such as one close to a wall, is connected by
//! straight lines to the nearest cells where it does, unless an obstacle lies between. The same holds
//! for a start near a [hazard](super::hazards); no path leads into one.
//!
//! Paths may be allowed through obstacles that are [stale](Occupancy::is_stale), at an extra cost per cell: the
//! robot then drives to where it can observe them.

use super::hazards::Hazards;
use crate::perception::beliefs::field::Field;
use crate::perception::beliefs::occupancy::Occupancy;
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use base::geometry::Point;

/// Costs of a step; 7 / 5 approximates the square root of 2.
const STRAIGHT: u16 = 5;
const DIAGONAL: u16 = 7;

/// The robot does not fit into the cell. Below all other costs, so that no step ever improves it.
const BLOCKED: u16 = 0;

/// Cost of the cells where the wavefront starts.
const START: u16 = 1;

const UNREACHED: u16 = u16::MAX;

/// An unreached cell into which the robot fits only if a stale obstacle has left, and one of these that the
/// wavefront has met and enters later.
const STALE: u16 = UNREACHED - 1;
const WAITING: u16 = UNREACHED - 2;

/// Extra cost of such a cell: that of a detour of 20 cells.
const STALE_COST: u16 = 20 * STRAIGHT;

/// The wavefront stops here: except in mazes, no path on a field of some thousand cells is longer.
const MAX_COST: u16 = WAITING - DIAGONAL - STALE_COST;

/// The distance of every cell from one position. Two bytes per cell, and four per open cell.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wavefront {
    origin: Point,
    /// Distances in fifths of a cell plus [`START`], row by row, with a blocked cell before each
    /// row and a blocked row before the first and after the last.
    costs: Vec<u16>,
    /// Offset from a cell to the one above it.
    stride: usize,
    hazards: Hazards,
    /// Whether the lines between neighbouring cells keep clear of hazards, not only their centres.
    is_wide: bool,
    /// Obstacles and hazards reach less than this number of cells.
    inflation: i32,
    /// Open cells, by their cost modulo 8.
    buckets: [Vec<u32>; 8],
    /// Whether paths lead through stale obstacles; and the cells there that are not entered yet, with their
    /// costs, which rise.
    passes_stale: bool,
    waiting: VecDeque<(u32, u16)>,
    is_complete: bool,
}

impl Wavefront {
    /// Keeps clear of hazards in later expansions.
    pub(crate) fn avoid(&mut self, hazards: &Hazards, is_wide: bool) {
        self.hazards.clone_from(hazards);
        self.is_wide = is_wide;
    }

    /// Whether paths lead through stale obstacles in later expansions.
    pub(crate) fn pass_stale(&mut self, passes_stale: bool) {
        self.passes_stale = passes_stale;
    }

    /// Whether the last expansion kept clear of the same hazards.
    pub(crate) fn avoids(&self, hazards: &Hazards) -> bool {
        self.hazards.are_same(hazards)
    }

    /// Expands the wavefront from `origin` for a robot that needs `clearance_m` on all sides.
    ///
    /// `visit` receives each cell that is reached with its distance, the nearest first; the
    /// expansion stops when it returns `false`.
    pub(crate) fn expand(
        &mut self,
        (field, map): (&Field, &Occupancy),
        origin: Point,
        clearance_m: f64,
        visit: impl FnMut(usize, f64) -> bool,
    ) {
        self.origin = origin;
        self.stride = field.columns + 1;
        self.clear(field);
        self.block_obstacles(field, map, clearance_m);
        self.block_hazards(field);
        self.start(field, map);
        self.is_complete = self.propagate(field, visit);
    }

    /// Opens all cells except those of the border.
    fn clear(&mut self, field: &Field) {
        self.costs.clear();
        self.costs.resize(self.stride, BLOCKED);
        for _ in 0..field.rows {
            self.costs.push(BLOCKED);
            let row = self.costs.len() + field.columns;
            self.costs.resize(row, UNREACHED);
        }
        self.costs
            .resize((field.rows + 2) * self.stride + 1, BLOCKED);
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "at most some thousands"
    )]
    fn block_obstacles(&mut self, field: &Field, map: &Occupancy, clearance_m: f64) {
        let max_cells = field.columns.max(field.rows) as f64;
        let clearance = (clearance_m / field.cell_m).max(0.0).min(max_cells);
        self.inflation = clearance as i32 + 1;
        for occupied in map.occupied() {
            let is_passed = self.passes_stale && map.is_stale(occupied);
            let mark = if is_passed { STALE } else { BLOCKED };
            let [column, row] = field.column_and_row_of(occupied);
            for up in 1 - self.inflation..self.inflation {
                for right in 1 - self.inflation..self.inflation {
                    let is_near = f64::from(right * right + up * up) <= clearance * clearance;
                    if let Some(cell) = field.number(column + right, row + up)
                        && is_near
                    {
                        let index = self.index(field, cell);
                        self.costs[index] = self.costs[index].min(mark);
                    }
                }
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "limited to the field")]
    fn block_hazards(&mut self, field: &Field) {
        for cell in self.hazards.cells(field, self.is_wide) {
            // As in `index`, which borrows all of `self`.
            let (column, row) = (cell % field.columns, cell / field.columns);
            self.costs[(row + 1) * self.stride + column + 1] = BLOCKED;
        }
        let reach = (self.hazards.max_radius_m() / field.cell_m) as i32;
        let max_cells = i32::try_from(field.columns.max(field.rows)).unwrap_or(i32::MAX);
        if reach > 0 {
            self.inflation = self.inflation.max(reach.min(max_cells) + 2);
        }
    }

    fn start(&mut self, field: &Field, map: &Occupancy) {
        self.buckets.iter_mut().for_each(Vec::clear);
        self.waiting.clear();
        let origin_cell = field.nearest_cell(self.origin);
        if !self.is_blocked(field, origin_cell) {
            let index = self.index(field, origin_cell);
            self.reach(index, START);
            return;
        }
        let origin = self.origin;
        for cell in field.around(origin_cell, self.inflation + 1) {
            let is_open = !self.is_blocked(field, cell);
            let centre = field.centre(cell);
            let is_clear = self.hazards.are_clear_between(origin, centre);
            if is_open && is_clear && is_connected(field, map, centre, origin) {
                let index = self.index(field, cell);
                self.reach(index, START);
            }
        }
    }

    /// Returns whether all reachable cells were visited.
    fn propagate(&mut self, field: &Field, mut visit: impl FnMut(usize, f64) -> bool) -> bool {
        let (mut cost, mut empty_buckets) = (START, 0);
        while (empty_buckets < 8 || !self.waiting.is_empty()) && cost < MAX_COST {
            self.enter_stale(cost);
            let mut front = core::mem::take(&mut self.buckets[usize::from(cost % 8)]);
            empty_buckets = if front.is_empty() {
                empty_buckets + 1
            } else {
                0
            };
            let distance_m = distance_m(field, cost);
            for index in front.iter().map(|index| *index as usize) {
                if self.costs[index] == cost {
                    self.relax_neighbours(index, cost);
                    let (row, column) = (index / self.stride - 1, index % self.stride - 1);
                    if !visit(row * field.columns + column, distance_m) {
                        return false;
                    }
                }
            }
            // Its allocation is reused.
            front.clear();
            self.buckets[usize::from(cost % 8)] = front;
            cost += 1;
        }
        true
    }

    /// Enters the stale cells that have waited for this cost.
    #[inline]
    fn enter_stale(&mut self, cost: u16) {
        while let Some(&(index, entered)) = self.waiting.front()
            && entered <= cost
        {
            self.costs[index as usize] = cost;
            self.buckets[usize::from(cost % 8)].push(index);
            self.waiting.pop_front();
        }
    }

    #[inline]
    fn relax_neighbours(&mut self, index: usize, cost: u16) {
        let (up, down) = (index + self.stride, index - self.stride);
        for next in [index + 1, index - 1, up, down] {
            if self.costs[next] > cost + STRAIGHT {
                self.reach(next, cost + STRAIGHT);
            }
        }
        for (row, side) in [(up, 1), (up, -1), (down, 1), (down, -1)] {
            let next = row.wrapping_add_signed(side);
            if self.costs[next] > cost + DIAGONAL && !self.is_gap(row, index, side) {
                self.reach(next, cost + DIAGONAL);
            }
        }
    }

    /// Whether a diagonal step, through a row and to a side, would pass between two blocked cells.
    #[inline]
    fn is_gap(&self, row: usize, index: usize, side: isize) -> bool {
        self.costs[row] == BLOCKED && self.costs[index.wrapping_add_signed(side)] == BLOCKED
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "at most 65,000 cells")]
    fn reach(&mut self, index: usize, cost: u16) {
        if matches!(self.costs[index], STALE | WAITING) {
            self.wait_for(index, cost);
            return;
        }
        self.costs[index] = cost;
        self.buckets[usize::from(cost % 8)].push(index as u32);
    }

    /// Meets a cell in a stale obstacle, which is entered later.
    #[expect(clippy::cast_possible_truncation, reason = "at most 65,000 cells")]
    fn wait_for(&mut self, index: usize, cost: u16) {
        if self.costs[index] == STALE {
            self.costs[index] = WAITING;
            self.waiting.push_back((index as u32, cost + STALE_COST));
        }
    }

    /// Index of a cell of the field in `costs`.
    #[inline]
    fn index(&self, field: &Field, cell: usize) -> usize {
        let (column, row) = (cell % field.columns, cell / field.columns);
        (row + 1) * self.stride + column + 1
    }

    /// Whether the distance of a position is known, or that it is unreachable.
    pub(crate) fn covers(&self, field: &Field, at: Point) -> bool {
        let cell = field.nearest_cell(at);
        self.is_complete || (!self.costs.is_empty() && self.cell_distance_m(field, cell).is_some())
    }

    /// Whether the robot does not fit into a cell.
    #[inline]
    pub(crate) fn is_blocked(&self, field: &Field, cell: usize) -> bool {
        self.costs[self.index(field, cell)] == BLOCKED
    }

    /// Path length to a cell; `None` if it is blocked or unreached.
    #[inline]
    pub(crate) fn cell_distance_m(&self, field: &Field, cell: usize) -> Option<f64> {
        let cost = self.costs[self.index(field, cell)];
        let is_reached = cost != BLOCKED && cost < WAITING;
        is_reached.then(|| distance_m(field, cost))
    }

    /// The cell by which the robot leaves a position where it does not fit, and the path length to
    /// that position; `None` if no such cell is connected to it.
    pub(crate) fn exit(&self, field: &Field, map: &Occupancy, at: Point) -> Option<(usize, f64)> {
        let cells = field.around(field.nearest_cell(at), self.inflation + 1);
        let distances = cells.filter_map(|cell| {
            let centre = field.centre(cell);
            let path_m = self.cell_distance_m(field, cell)? + centre.to(at).length();
            let enters = !self.hazards.are_clear_between(at, centre);
            is_connected(field, map, centre, at).then_some((enters, path_m, cell))
        });
        // A robot among several hazards may have no way that enters none.
        let order = |one: &(bool, f64, usize), other: &(bool, f64, usize)| {
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        };
        let (_, path_m, cell) = distances.min_by(order)?;
        Some((cell, path_m))
    }

    /// The next cell on the path from a cell to the origin; `None` at the origin.
    fn next(&self, field: &Field, cell: usize) -> Option<usize> {
        let index = self.index(field, cell);
        let [column, row] = field.column_and_row_of(cell);
        let (up, down) = (index + self.stride, index - self.stride);
        let straight = [
            (1, 0, index + 1),
            (-1, 0, index - 1),
            (0, 1, up),
            (0, -1, down),
        ];
        let diagonal = [(1, 1, up), (-1, 1, up), (1, -1, down), (-1, -1, down)];
        let diagonal = diagonal
            .into_iter()
            .filter(|(side, _, row)| !self.is_gap(*row, index, *side as isize))
            .map(|(side, level, row)| {
                (
                    side,
                    level,
                    row.wrapping_add_signed(side as isize),
                    DIAGONAL,
                )
            });
        let straight = straight
            .into_iter()
            .map(|(side, level, next)| (side, level, next, STRAIGHT));
        let all = straight
            .chain(diagonal)
            .filter_map(|(side, level, next, step)| {
                let cost = self.costs[next];
                let cell = field.number(column + side, row + level)?;
                (cost != BLOCKED).then(|| (cost.saturating_add(step), cell, cost))
            });
        let (_, next, cost) = all.min()?;
        (cost < self.costs[index]).then_some(next)
    }

    /// The farthest point on the path from `at` to the origin that can be reached in a straight
    /// line; `None` if there is no path.
    pub(crate) fn waypoint(&self, field: &Field, map: &Occupancy, at: Point) -> Option<Point> {
        let mut cell = field.nearest_cell(at);
        let Some(_) = self.cell_distance_m(field, cell) else {
            let (exit, _) = self.exit(field, map, at)?;
            return Some(field.centre(exit));
        };
        let mut farthest = None;
        while let Some(next) = self.next(field, cell) {
            let centre = field.centre(next);
            let is_free = || {
                self.is_open_between(field, at, centre)
                    && self.hazards.are_clear_between(at, centre)
                    && (!self.passes_stale || map.is_free_between(field, at, centre))
            };
            if farthest.is_some() && !is_free() {
                break;
            }
            (farthest, cell) = (Some(centre), next);
        }
        // From the cells where the wavefront started, the origin is reached in a straight line.
        Some(farthest.unwrap_or(self.origin))
    }

    /// Whether the robot fits through all cells on the straight line between two points.
    pub(crate) fn is_open_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let line = from.to(to);
        let length_m = line.length();
        let direction = line.times(1.0 / length_m.max(f64::MIN_POSITIVE));
        !field
            .along(from, direction, length_m)
            .any(|cell| self.is_blocked(field, cell))
    }
}

#[inline]
fn distance_m(field: &Field, cost: u16) -> f64 {
    f64::from(cost - START) / f64::from(STRAIGHT) * field.cell_m
}

/// Whether no obstacle lies between an open cell and a point near it, which may be occupied itself.
pub(crate) fn is_connected(field: &Field, map: &Occupancy, open: Point, at: Point) -> bool {
    if map.is_occupied(field.nearest_cell(at)) {
        map.is_visible(field, open, at, 0.0)
    } else {
        map.is_free_between(field, open, at)
    }
}

#[cfg(test)]
mod tests;
