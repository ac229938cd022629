//! A grid of cells.

/// Maximum number of cells of a map.
pub const MAX_CELLS: usize = 64_000_000;

/// A grid of cells, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    columns: u32,
    rows: u32,
    cells: Vec<i8>,
}

/// Number of cells of a grid; `None` above the maximum.
pub(super) fn size(columns: u32, rows: u32) -> Option<usize> {
    let cells = u64::from(columns) * u64::from(rows);
    usize::try_from(cells)
        .ok()
        .filter(|&cells| cells <= MAX_CELLS)
}

impl Grid {
    /// The grid of these cells, the lowest row first; `None` if their number does not match.
    pub(super) fn new(columns: u32, rows: u32, cells: Vec<i8>) -> Option<Self> {
        (size(columns, rows)? == cells.len()).then_some(Self {
            columns,
            rows,
            cells,
        })
    }

    pub(super) fn columns(&self) -> u32 {
        self.columns
    }

    pub(super) fn rows(&self) -> u32 {
        self.rows
    }

    pub(super) fn get(&self, column: u32, row: u32) -> Option<i8> {
        let is_inside = column < self.columns && row < self.rows;
        is_inside.then(|| self.cells[row as usize * self.columns as usize + column as usize])
    }
}
