//! Square cells over the world, and what is near each.

use base::geometry::Point;
use std::ops::Range;

/// Maximum number of cells of a grid: lists for more would fill the memory of a small machine.
const MAX_CELLS: f64 = 4e6;

/// Maximum number of cells of a grid over a few things, and of additional cells for each of them: a
/// large, sparse world needs little memory.
const CELLS: f64 = 4096.0;
const CELLS_PER_THING: f64 = 64.0;

/// Target for the number of entries in the lists of a grid.
const MAX_ENTRIES: usize = 1 << 24;

/// Square cells over a rectangle with a corner at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Grid {
    cells_per_m: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Cells of `cell_m` or larger over `size_m`.
    pub(crate) fn new(size_m: Point, cell_m: f64) -> Self {
        Self::of_at_most(MAX_CELLS, size_m, cell_m)
    }

    /// The same for a number of things that are searched by place.
    #[expect(clippy::cast_precision_loss, reason = "at most millions")]
    pub(crate) fn over(things: usize, size_m: Point, cell_m: f64) -> Self {
        let most = CELLS + CELLS_PER_THING * things as f64;
        Self::of_at_most(most.min(MAX_CELLS), size_m, cell_m)
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most MAX_CELLS, and at least 1"
    )]
    fn of_at_most(most: f64, size_m: Point, cell_m: f64) -> Self {
        let cell_m = cell_m.max((size_m.x * size_m.y / most).sqrt());
        let cell_m = cell_m.max(size_m.x.max(size_m.y) / most);
        let count = |length: f64| (length / cell_m).ceil().max(1.0) as usize;
        Self {
            cells_per_m: 1.0 / cell_m,
            columns: count(size_m.x),
            rows: count(size_m.y),
        }
    }

    pub(crate) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    pub(crate) fn cell_m(&self) -> f64 {
        1.0 / self.cells_per_m
    }

    /// The column and row of a point; for a point outside, the nearest ones.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast from float to integer saturates"
    )]
    pub(crate) fn place(&self, point: Point) -> [usize; 2] {
        let column = (point.x * self.cells_per_m) as usize;
        let row = (point.y * self.cells_per_m) as usize;
        [column.min(self.columns - 1), row.min(self.rows - 1)]
    }

    /// The number of the cell in a column and row.
    #[inline]
    pub(crate) fn number(&self, [column, row]: [usize; 2]) -> usize {
        row * self.columns + column
    }

    /// The number of the cell that contains a point.
    #[inline]
    pub(crate) fn cell(&self, point: Point) -> usize {
        self.number(self.place(point))
    }

    /// For each row that a box touches, the numbers of its cells.
    #[inline]
    pub(crate) fn rows_of(&self, low: Point, high: Point) -> impl Iterator<Item = Range<usize>> {
        let ([left, bottom], [right, top]) = (self.place(low), self.place(high));
        let grid = *self;
        (bottom..=top).map(move |row| grid.number([left, row])..grid.number([right, row]) + 1)
    }

    /// The numbers of cells that contain every point between two places, and possibly some more.
    pub(crate) fn cells_along(&self, from: Point, to: Point) -> impl Iterator<Item = usize> {
        let grid = *self;
        let [[_, first], [_, last]] = [grid.place(from), grid.place(to)];
        let rows = first.min(last)..=first.max(last);
        rows.flat_map(move |row| {
            let [left, right] = grid.crossed_in_row(row, from, to);
            grid.number([left, row])..grid.number([right, row]) + 1
        })
    }

    /// The first and last column of the cells that a segment crosses in a row.
    #[expect(clippy::cast_precision_loss, reason = "at most MAX_CELLS")]
    fn crossed_in_row(&self, row: usize, from: Point, to: Point) -> [usize; 2] {
        let way = from.to(to);
        let x_at = |y: f64| {
            let share = (y - from.y) / way.y;
            // Along a row, and by rounding, the fraction may be anything: then the whole segment
            // counts.
            from.x + way.x * share.clamp(0.0, 1.0)
        };
        let (mut low, mut high) = (row as f64 * self.cell_m(), (row + 1) as f64 * self.cell_m());
        // A point outside belongs to the nearest cell.
        if row == 0 {
            low = f64::NEG_INFINITY;
        }
        if row + 1 == self.rows {
            high = f64::INFINITY;
        }
        let ends = if way.y.abs() < 1e-9 {
            [from.x, to.x]
        } else {
            [x_at(low), x_at(high)]
        };
        // A small margin on either side, for rounding.
        let hair = 1e-6 * self.cell_m();
        let column = |x: f64| self.place(Point { x, y: 0.0 })[0];
        [
            column(ends[0].min(ends[1]) - hair),
            column(ends[0].max(ends[1]) + hair),
        ]
    }

    /// The centre of the cell with a number.
    #[expect(clippy::cast_precision_loss, reason = "at most MAX_CELLS")]
    pub(crate) fn middle(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        Point {
            x: (column as f64 + 0.5) * self.cell_m(),
            y: (row as f64 + 0.5) * self.cell_m(),
        }
    }
}

/// Something static, as grids need to know it.
pub(crate) trait Still {
    /// Its minimum and maximum coordinates.
    fn bounds(&self) -> [Point; 2];

    /// Its distance from a point; 0 inside.
    fn distance(&self, from: Point) -> f64;
}

/// For each cell of a grid, the numbers of the things within reach of any of its points.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NearCells {
    grid: Grid,
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

impl NearCells {
    /// With cells as small as is useful, as far as memory allows.
    pub(crate) fn new<T: Still>(size_m: Point, things: &[T], reach_m: f64) -> Self {
        let mut grid = Grid::over(things.len(), size_m, (reach_m / 2.0).max(0.25));
        loop {
            let near = Self::on(grid, things, reach_m);
            if near.numbers.len() <= MAX_ENTRIES || grid.cells() == 1 {
                return near;
            }
            grid = Grid::new(size_m, 2.0 * grid.cell_m());
        }
    }

    fn on<T: Still>(grid: Grid, things: &[T], reach_m: f64) -> Self {
        let mut entries: Vec<(u32, u32)> = Vec::new();
        let corner_m = grid.cell_m() * std::f64::consts::FRAC_1_SQRT_2;
        for (number, thing) in (0..).zip(things) {
            let [low, high] = thing.bounds().map(|end| [end.x, end.y]);
            let low = Point::from(low.map(|end| end - reach_m));
            let high = Point::from(high.map(|end| end + reach_m));
            for cell in grid.rows_of(low, high).flatten() {
                if thing.distance(grid.middle(cell)) <= reach_m + corner_m {
                    entries.push((u32::try_from(cell).unwrap_or(u32::MAX), number));
                }
            }
            if entries.len() > 2 * MAX_ENTRIES {
                break;
            }
        }
        // Stable: within a cell the numbers ascend.
        entries.sort_by_key(|(cell, _)| *cell);
        let mut starts = vec![0; grid.cells() + 1];
        for (cell, _) in &entries {
            starts[*cell as usize + 1] += 1;
        }
        for cell in 0..grid.cells() {
            starts[cell + 1] += starts[cell];
        }
        Self {
            grid,
            starts,
            numbers: entries.into_iter().map(|(_, number)| number).collect(),
        }
    }

    pub(crate) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What is within reach of a point.
    #[inline]
    pub(crate) fn at(&self, point: Point) -> &[u32] {
        self.of(self.grid.cell(point))
    }

    /// What is within reach of any point of a box, in the order of the numbers.
    pub(crate) fn within(&self, low: Point, high: Point) -> Vec<u32> {
        let cells = self.grid.rows_of(low, high).flatten();
        let mut numbers: Vec<u32> = cells.flat_map(|cell| self.of(cell)).copied().collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// What is within reach of any point of a cell.
    #[inline]
    pub(crate) fn of(&self, cell: usize) -> &[u32] {
        &self.numbers[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

#[cfg(test)]
mod tests;
