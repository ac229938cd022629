//! A grid of cells.

use crate::hashed::Hashed;

/// Maximum number of cells of a map.
pub const MAX_CELLS: usize = 64_000_000;

/// A grid of cells, row by row.
#[derive(Debug, Clone, PartialEq, Hashed)]
pub(super) struct Grid {
    columns: u32,
    rows: u32,
    cells: Vec<i8>,
}

/// Number of cells of an image.
///
/// # Errors
/// If it is above the maximum.
pub(super) fn size(columns: u32, rows: u32) -> Result<usize, String> {
    let cells = u64::from(columns) * u64::from(rows);
    usize::try_from(cells)
        .ok()
        .filter(|&cells| cells <= MAX_CELLS)
        .ok_or_else(|| {
            format!("the image must have at most {MAX_CELLS} pixels, not {columns} x {rows}")
        })
}

fn turn_upside_down(cells: &mut [i8], columns: usize) {
    let rows = cells.len() / columns.max(1);
    let (top, bottom) = cells.split_at_mut(rows / 2 * columns);
    let pairs = top
        .chunks_exact_mut(columns)
        .zip(bottom.rchunks_exact_mut(columns));
    pairs.for_each(|(upper, lower)| upper.swap_with_slice(lower));
}

impl Grid {
    /// The grid of the cells of an image, whose last row becomes the lowest; `None` if their number
    /// does not match.
    pub(super) fn of_image(columns: u32, rows: u32, mut cells: Vec<i8>) -> Option<Self> {
        if size(columns, rows) != Ok(cells.len()) {
            return None;
        }
        turn_upside_down(&mut cells, columns as usize);
        Some(Self {
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
