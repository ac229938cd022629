//! Cells as runs, of which a row has far fewer than cells.

use super::cells::Run;
use std::mem::replace;
use std::ops::Range;

/// Runs of cells in the order of rows and columns, of which no two share a side in a row.
#[derive(Debug, Clone)]
pub(super) struct Runs(Vec<Run>);

impl Runs {
    /// The open cells, of rows of `columns` cells.
    pub(super) fn open(is_closed: &[bool], columns: usize) -> Self {
        let rows = (0_u32..).zip(is_closed.chunks_exact(columns));
        Self(
            rows.flat_map(|(row, is_closed)| open_runs(row, is_closed))
                .collect(),
        )
    }

    /// Whether `run` contains one of the cells.
    pub(super) fn overlap(&self, run: &Run) -> bool {
        !self.overlapping(run).is_empty()
    }

    /// The runs that are connected to a cell of `starts`, by sides and corners.
    pub(super) fn connected_to(self, starts: impl Iterator<Item = Run>) -> Self {
        let mut is_connected = vec![false; self.0.len()];
        let mut ahead: Vec<Run> = starts.collect();
        while let Some(next) = ahead.pop() {
            for index in self.overlapping(&next) {
                if !replace(&mut is_connected[index], true) {
                    ahead.extend(self.0[index].beside());
                }
            }
        }
        let runs = self.0.into_iter().zip(is_connected);
        Self(
            runs.filter_map(|(run, is_connected)| is_connected.then_some(run))
                .collect(),
        )
    }

    /// The indices of the runs that share a cell with `run`.
    fn overlapping(&self, run: &Run) -> Range<usize> {
        let (low, high) = (run.columns.start(), run.columns.end());
        let first = self
            .0
            .partition_point(|each| (each.row, each.columns.end()) < (run.row, low));
        let after = self
            .0
            .partition_point(|each| (each.row, each.columns.start()) <= (run.row, high));
        first..after
    }
}

impl Run {
    /// The cells of the rows below and above that share a side or a corner with the run, if they exist.
    fn beside(&self) -> impl Iterator<Item = Self> + use<> {
        let columns = self.columns.start().saturating_sub(1)..=self.columns.end() + 1;
        let rows = [self.row.checked_sub(1), Some(self.row + 1)];
        rows.into_iter().flatten().map(move |row| Self {
            row,
            columns: columns.clone(),
        })
    }
}

/// The runs of open cells in a row.
fn open_runs(row: u32, is_closed: &[bool]) -> impl Iterator<Item = Run> {
    let mut next = 0;
    is_closed
        .chunk_by(|one, other| *one == *other)
        .filter_map(move |equal| {
            let first = next;
            next += u32::try_from(equal.len()).unwrap_or(u32::MAX);
            (!equal[0]).then(|| Run {
                row,
                columns: first..=next - 1,
            })
        })
}
