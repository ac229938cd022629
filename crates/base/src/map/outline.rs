//! The boundary between solid and free cells.

use super::grid::Grid;
use crate::geometry::{Point, Segment};

/// Maximum number of straight walls of a map.
pub const MAX_SEGMENTS: usize = 4_000_000;

/// The boundary between cells that are `is_solid` and the others, as maximal straight segments with free
/// space on their left; `corner` converts cell corners to world coordinates. `None` if there are too
/// many.
///
/// A segment along a grid line continues while the same side is solid. Where another segment meets it,
/// the cells around that corner alternate between solid and free, and it ends there: segments meet at
/// their ends only.
pub(super) fn trace(
    grid: &Grid,
    is_solid: impl Fn(i8) -> bool,
    corner: impl Fn(u32, u32) -> Point,
) -> Option<Vec<Segment>> {
    let solid = |column: Option<u32>, row: Option<u32>| {
        let at = column
            .zip(row)
            .and_then(|(column, row)| grid.get(column, row));
        at.is_some_and(&is_solid)
    };
    let (columns, rows) = (grid.columns(), grid.rows());
    let mut edges = Vec::new();
    for line in 0..=rows {
        let sides = |at| [line.checked_sub(1), Some(line)].map(|row| solid(Some(at), row));
        // Free above, so along x; free below, so against it.
        runs(
            columns,
            sides,
            |from, to| (corner(from, line), corner(to, line)),
            &mut edges,
        )?;
    }
    for line in 0..=columns {
        // Free on the left, so along y: the sides are given from the right to the left.
        let sides = |at| [Some(line), line.checked_sub(1)].map(|column| solid(column, Some(at)));
        runs(
            rows,
            sides,
            |from, to| (corner(line, from), corner(line, to)),
            &mut edges,
        )?;
    }
    Some(edges)
}

/// The edges along one line of the grid of `length` cells: from start to end where only the first of
/// the `sides` is solid, back where only the second is.
fn runs(
    length: u32,
    sides: impl Fn(u32) -> [bool; 2],
    ends: impl Fn(u32, u32) -> (Point, Point),
    edges: &mut Vec<Segment>,
) -> Option<()> {
    let (mut start, mut open) = (0, [false; 2]);
    for at in 0..=length {
        let here = if at < length { sides(at) } else { [false; 2] };
        if here == open {
            continue;
        }
        if open[0] != open[1] {
            let (begin, end) = ends(start, at);
            let (from, to) = if open[0] { (begin, end) } else { (end, begin) };
            edges.push(Segment { from, to });
        }
        if edges.len() > MAX_SEGMENTS {
            return None;
        }
        (start, open) = (at, here);
    }
    Some(())
}
