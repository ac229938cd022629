//! Cells as runs, of which a row has far fewer than cells.

use super::cells::Run;
use std::ops::Range;

/// The part of a run that has none yet.
const NONE: u32 = u32::MAX;

/// Runs of open cells in the order of rows and columns, of which no two share a side in a row.
#[derive(Debug, Clone)]
pub(super) struct Runs {
    in_order: Vec<Run>,
    /// By row, the index of its first run; and after the last row, the number of runs.
    rows: Vec<usize>,
    /// By run, the number of its part: runs that are connected by sides and corners are one part.
    parts: Vec<u32>,
    /// By part, its first run.
    firsts: Vec<usize>,
}

impl Runs {
    /// The open cells, of rows of `columns` cells.
    pub(super) fn open(is_closed: &[bool], columns: usize) -> Self {
        let mut in_order = Vec::new();
        let mut rows = vec![0];
        for (row, is_closed) in (0_u32..).zip(is_closed.chunks_exact(columns)) {
            in_order.extend(open_runs(row, is_closed));
            rows.push(in_order.len());
        }
        let mut open = Self {
            in_order,
            rows,
            parts: Vec::new(),
            firsts: Vec::new(),
        };
        open.number_parts();
        open
    }

    /// The parts that have a cell in `run`; a part may be repeated.
    pub(super) fn parts_in<'r>(&'r self, run: &Run) -> impl Iterator<Item = u32> + use<'r> {
        self.parts[self.overlapping(run)].iter().copied()
    }

    /// Number of parts.
    pub(super) fn count(&self) -> usize {
        self.firsts.len()
    }

    /// The first run of a part.
    pub(super) fn first_of(&self, part: u32) -> Option<&Run> {
        let first = self.firsts.get(part as usize)?;
        self.in_order.get(*first)
    }

    fn number_parts(&mut self) {
        self.parts = vec![NONE; self.in_order.len()];
        let mut number = 0;
        for first in 0..self.in_order.len() {
            if self.parts[first] == NONE {
                self.firsts.push(first);
                self.fill(first, number);
                number += 1;
            }
        }
    }

    /// Numbers the runs that are connected to the first.
    fn fill(&mut self, first: usize, number: u32) {
        self.parts[first] = number;
        let mut ahead = vec![first];
        while let Some(next) = ahead.pop() {
            for beside in self.in_order[next].beside() {
                for index in self.overlapping(&beside) {
                    if self.parts[index] == NONE {
                        self.parts[index] = number;
                        ahead.push(index);
                    }
                }
            }
        }
    }

    /// The indices of the runs that share a cell with `run`.
    fn overlapping(&self, run: &Run) -> Range<usize> {
        let row = run.row as usize;
        let (Some(&start), Some(&end)) = (self.rows.get(row), self.rows.get(row + 1)) else {
            return 0..0;
        };
        let in_row = &self.in_order[start..end];
        let first = in_row.partition_point(|each| each.columns.end() < run.columns.start());
        let after = in_row.partition_point(|each| each.columns.start() <= run.columns.end());
        start + first..start + after
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
