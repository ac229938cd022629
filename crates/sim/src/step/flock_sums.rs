//! Sums over all robots in range of each robot, which is all that flocking needs.
//!
//! A list of neighbours with ranges and bearings costs ten times as much as the rule that uses it,
//! so the sums are computed from places alone. Robots are sorted by square cells as wide as the
//! range, strip by strip and row by row: the robots in range of one are in three runs of the sorted
//! list, the cells beside its own in its row and in those above and below; more where a strip ends
//! or where the world is periodic. Strips are so narrow that three rows of one fit into the fastest
//! cache.

mod gather;

use crate::bodies::path::Orientation;
use crate::sensors::rays::GROUP;
use base::geometry::{Disc, Point, Torus};
use brain::AgentId;
use rayon::prelude::*;

/// Robots of a periodic world, sorted by cells.
#[derive(Debug, Clone)]
pub(crate) struct Flock {
    torus: Torus,
    reach_m: f64,
    columns: usize,
    rows: usize,
    /// Where the robots of each cell start, row by row, and the end.
    starts: Vec<u32>,
    /// The robot at each place of the list, its kind, and the inverse.
    pub(crate) robots: Vec<u32>,
    pub(crate) kinds: Vec<u8>,
    pub(crate) places: Vec<u32>,
    /// In the order of the list, with room for a whole block at the end.
    x: Vec<f64>,
    y: Vec<f64>,
    course_x: Vec<f64>,
    course_y: Vec<f64>,
}

/// Robots per task of a thread.
const TOGETHER: usize = 1024;

/// Some robots, and where their places and orientations are written.
type Copied<'a> = (
    (&'a [u32], (&'a mut [f64], &'a mut [f64])),
    (&'a mut [f64], &'a mut [f64]),
);

/// Columns of a strip.
const STRIP: usize = 32;

/// Consecutive robots in the list, and the offset of their images.
#[derive(Debug, Clone, Copy, Default)]
struct Run {
    start: usize,
    end: usize,
    shift: Point,
}

/// The runs that contain all robots in range of those of a cell: up to three in each of three rows.
#[derive(Debug, Clone, Copy, Default)]
struct Runs {
    all: [Run; 9],
    count: usize,
}

impl Flock {
    /// For robots with a range of at most `reach_m`, at most half of the world.
    pub(crate) fn new(torus: Torus, reach_m: f64) -> Self {
        Self {
            torus,
            reach_m,
            columns: 1,
            rows: 1,
            starts: Vec::new(),
            robots: Vec::new(),
            kinds: Vec::new(),
            places: Vec::new(),
            x: Vec::new(),
            y: Vec::new(),
            course_x: Vec::new(),
            course_y: Vec::new(),
        }
    }

    /// Sorts robots by place; threads may share the work.
    pub(crate) fn fill(
        &mut self,
        ids: &[AgentId],
        discs: &[Disc],
        orientations: &[Orientation],
        is_shared: bool,
    ) {
        self.lay_out(ids.len());
        self.count(discs, is_shared);
        self.robots.resize(ids.len(), 0);
        self.kinds.resize(ids.len(), 0);
        for ((robot, id), cell) in (0..).zip(ids).zip(&mut self.places) {
            let start = &mut self.starts[*cell as usize];
            *cell = *start;
            self.robots[*start as usize] = robot;
            self.kinds[*start as usize] = id.kind;
            *start += 1;
        }
        // Each cell's start has moved to its end, which is where the next one starts.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.copy(discs, orientations, is_shared);
    }

    /// Copies the places of robots in the order of the list.
    fn copy(&mut self, discs: &[Disc], orientations: &[Orientation], is_shared: bool) {
        let robots = &self.robots[..];
        let values = [
            &mut self.x,
            &mut self.y,
            &mut self.course_x,
            &mut self.course_y,
        ];
        let [x, y, course_x, course_y] = values.map(|values| {
            values.resize(robots.len() + GROUP, 0.0);
            &mut values[..robots.len()]
        });
        let some = |((robots, (x, y)), (course_x, course_y)): Copied| {
            for (place, robot) in robots.iter().enumerate() {
                let (at, front) = (
                    discs[*robot as usize].centre,
                    orientations[*robot as usize].front,
                );
                (x[place], y[place]) = (at.x, at.y);
                (course_x[place], course_y[place]) = (front.x, front.y);
            }
        };
        if !is_shared {
            return some(((robots, (x, y)), (course_x, course_y)));
        }
        let places = x.par_chunks_mut(TOGETHER).zip(y.par_chunks_mut(TOGETHER));
        let fronts = course_x.par_chunks_mut(TOGETHER);
        let fronts = fronts.zip(course_y.par_chunks_mut(TOGETHER));
        let tasks = robots.par_chunks(TOGETHER).zip(places).zip(fronts);
        tasks.for_each(some);
    }

    /// Cells that are as wide as the range, but hardly more of them than robots.
    fn lay_out(&mut self, robots: usize) {
        let Point { x, y } = self.torus.size_m;
        #[expect(clippy::cast_precision_loss, reason = "at most millions")]
        let cell_m = self.reach_m.max((x * y / robots.max(1) as f64).sqrt());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most as many as robots"
        )]
        let cells = |length_m: f64| ((length_m / cell_m) as usize).max(1);
        (self.columns, self.rows) = (cells(x), cells(y));
    }

    /// Where the robots of each cell will start and, for now, the cell of each robot.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "places are within the torus, and cells hardly more than robots"
    )]
    fn count(&mut self, discs: &[Disc], is_shared: bool) {
        let (columns, rows) = (self.columns, self.rows);
        let per_m = [
            columns as f64 / self.torus.size_m.x,
            rows as f64 / self.torus.size_m.y,
        ];
        self.starts.clear();
        self.starts.resize(columns * rows + 1, 0);
        self.places.resize(discs.len(), 0);
        let cell_of = |(to, disc): (&mut u32, &Disc)| {
            let place = disc.centre;
            let column = ((place.x * per_m[0]) as usize).min(columns - 1);
            let row = ((place.y * per_m[1]) as usize).min(rows - 1);
            *to = cell(column, row, [columns, rows]) as u32;
        };
        if is_shared {
            let tasks = self.places.par_iter_mut().with_min_len(TOGETHER);
            tasks.zip(discs).for_each(cell_of);
        } else {
            self.places.iter_mut().zip(discs).for_each(cell_of);
        }
        for cell in &self.places {
            self.starts[*cell as usize + 1] += 1;
        }
        for cell in 0..columns * rows {
            self.starts[cell + 1] += self.starts[cell];
        }
    }
}

impl Flock {
    /// The orientation of the robot at a place of the list.
    pub(crate) fn course(&self, place: usize) -> Point {
        Point {
            x: self.course_x[place],
            y: self.course_y[place],
        }
    }

    fn runs(&self, cell: usize) -> Runs {
        let cells = [self.columns, self.rows];
        let [column, row] = place(cell, cells);
        let columns = beside(column, self.columns, self.torus.size_m.x);
        let rows = beside(row, self.rows, self.torus.size_m.y);
        let mut runs = Runs::default();
        for (row, shift_y) in rows {
            for (column, shift_x) in columns {
                let cell = self::cell(column, row, cells);
                let [start, end] = [cell, cell + 1].map(|cell| self.starts[cell] as usize);
                let shift = Point {
                    x: shift_x,
                    y: shift_y,
                };
                runs.add(Run { start, end, shift });
            }
        }
        runs
    }
}

impl Runs {
    /// Adds a run, merged with the last one if it continues it.
    fn add(&mut self, run: Run) {
        let last = self.count.checked_sub(1).map(|last| &mut self.all[last]);
        match last {
            Some(last) if last.end == run.start && last.shift == run.shift => last.end = run.end,
            _ => {
                self.all[self.count] = run;
                self.count += 1;
            }
        }
    }
}

/// The number of a cell in a grid of columns and rows: strip by strip, and row by row.
#[inline]
fn cell(column: usize, row: usize, [columns, rows]: [usize; 2]) -> usize {
    let first = column / STRIP * STRIP;
    let width = STRIP.min(columns - first);
    first * rows + row * width + (column - first)
}

/// The column and row of a cell.
fn place(cell: usize, [columns, rows]: [usize; 2]) -> [usize; 2] {
    let first = cell / (STRIP * rows) * STRIP;
    let width = STRIP.min(columns - first);
    let rest = cell - first * rows;
    [first + rest % width, rest / width]
}

/// The cells before, at and after one on a periodic axis, and the offset of their images.
fn beside(cell: usize, cells: usize, size_m: f64) -> [(usize, f64); 3] {
    let before = cell.checked_sub(1).map(|before| (before, 0.0));
    let after = (cell + 1 < cells).then_some((cell + 1, 0.0));
    [
        before.unwrap_or((cells - 1, -size_m)),
        (cell, 0.0),
        after.unwrap_or((0, size_m)),
    ]
}

#[cfg(test)]
mod tests;
