//! The world of 25 x 25 cells: frame, obstacles, items, and a grid that counts the contents of cells.

/// Number of cells along each side; cells are indexed 0..25, x to the right and y down.
pub const SIZE: i32 = 25;

/// Side length of a cell, in pixels.
pub const CELL_PX: f32 = 20.0;

/// The four items to find.
pub const ITEMS: [Cell; 4] = [
    Cell { x: 3, y: 17 },
    Cell { x: 9, y: 5 },
    Cell { x: 14, y: 22 },
    Cell { x: 21, y: 8 },
];

/// Obstacles inside the frame: left, top, right, bottom cell, ends included.
const OBSTACLES: [[i32; 4]; 4] = [
    [4, 1, 5, 3],
    [3, 11, 5, 11],
    [15, 6, 15, 9],
    [12, 19, 14, 19],
];

/// A cell, possibly outside the grid: a robot may leave it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Cell {
    /// Columns to the right.
    pub x: i32,
    /// Rows down.
    pub y: i32,
}

impl Cell {
    /// The cell `steps` times `step` away.
    pub(crate) fn ahead(self, step: (i32, i32), steps: i32) -> Self {
        Self {
            x: self.x + step.0 * steps,
            y: self.y + step.1 * steps,
        }
    }

    /// Columns and rows between two cells.
    pub(crate) fn gaps(self, other: Self) -> (i32, i32) {
        ((self.x - other.x).abs(), (self.y - other.y).abs())
    }

    /// Whether the cell is in the grid and at least `margin` cells from its edge.
    pub(crate) fn is_inside(self, margin: i32) -> bool {
        let allowed = margin..SIZE - margin;
        allowed.contains(&self.x) && allowed.contains(&self.y)
    }

    /// Whether frame, obstacle or item fills the cell. Items are not special to robots.
    #[must_use]
    pub fn is_static(self) -> bool {
        let in_obstacle = |[left, top, right, bottom]: [i32; 4]| {
            (left..=right).contains(&self.x) && (top..=bottom).contains(&self.y)
        };
        let on_frame = self.is_inside(0) && !self.is_inside(1);
        on_frame || OBSTACLES.into_iter().any(in_obstacle) || ITEMS.contains(&self)
    }
}

/// All cells of the grid, column by column.
pub fn cells() -> impl Iterator<Item = Cell> {
    (0..SIZE).flat_map(|x| (0..SIZE).map(move |y| Cell { x, y }))
}

/// Contents of each cell: 1 for static content, plus 1 for each robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Grid {
    counts: Vec<u32>,
}

impl Grid {
    /// A grid with the static content only.
    pub(crate) fn new() -> Self {
        Self {
            counts: cells().map(|cell| u32::from(cell.is_static())).collect(),
        }
    }

    /// Static content, then each of `robots` that is inside the grid.
    pub(crate) fn refresh(&mut self, robots: impl Iterator<Item = Cell>) {
        *self = Self::new();
        for index in robots.filter_map(index) {
            self.counts[index] += 1;
        }
    }

    /// The count of a cell; `None` outside the grid.
    pub(crate) fn count(&self, cell: Cell) -> Option<u32> {
        index(cell).map(|index| self.counts[index])
    }

    /// Whether a cell is occupied. Cells outside the grid are not.
    pub(crate) fn is_filled(&self, cell: Cell) -> bool {
        self.count(cell).is_some_and(|count| count > 0)
    }
}

fn index(cell: Cell) -> Option<usize> {
    cell.is_inside(0)
        .then(|| usize::try_from(cell.x * SIZE + cell.y).ok())
        .flatten()
}
