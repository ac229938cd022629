//! The grid of cells over the mission area.

use base::geometry::{Point, Rectangle};
use base::hashed::Hashed;
use core::ops::Range;

/// Fractional bits of fixed-point coordinates.
const FRACTION_BITS: u32 = 20;

/// A rectangle of square cells, row by row from the lower left corner.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct Field {
    area: Rectangle,
    pub(crate) cell_m: f64,
    cells_per_m: f64,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Field {
    /// Covers `area` with at most `max_cells` cells that are at least `min_cell_m` wide.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "at most some thousands"
    )]
    pub(crate) fn new(area: &Rectangle, min_cell_m: f64, max_cells: usize) -> Self {
        let size = area.size();
        // (width / cell + 1) (height / cell + 1) = max_cells, since both are rounded up. The root that
        // adds numbers of equal sign: the other one cancels for a long and narrow area.
        let (sum_m, area_m2) = (size.x + size.y, size.x * size.y);
        let more = max_cells.max(4) as f64 - 1.0;
        let root = libm::sqrt(sum_m * sum_m + 4.0 * area_m2 * more);
        let coarse_m = (root + sum_m) / (2.0 * more);
        let cell_m = min_cell_m.max(coarse_m);
        let count = |length_m: f64| (libm::ceil(length_m / cell_m) as usize).max(1);
        Self {
            area: *area,
            cell_m,
            cells_per_m: 1.0 / cell_m,
            columns: count(size.x),
            rows: count(size.y),
        }
    }

    pub(crate) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The cell that contains a position, if any.
    #[inline]
    pub(crate) fn cell(&self, position: Point) -> Option<usize> {
        let [column, row] = self.column_and_row(position);
        self.number(column, row)
    }

    /// The cell nearest to a position.
    pub(crate) fn nearest_cell(&self, position: Point) -> usize {
        let [column, row] = self.column_and_row(position);
        let within =
            |number: i32, count: usize| usize::try_from(number).unwrap_or(0).min(count - 1);
        within(row, self.rows) * self.columns + within(column, self.columns)
    }

    /// Column and row of a position, also outside the field.
    #[inline]
    pub(crate) fn column_and_row(&self, position: Point) -> [i32; 2] {
        let [right, up] = self.in_cells(position);
        [floor(right), floor(up)]
    }

    /// A position in units of cells from the lower left corner.
    #[inline]
    pub(crate) fn in_cells(&self, position: Point) -> [f64; 2] {
        let offset = self.area.min().to(position);
        [offset.x * self.cells_per_m, offset.y * self.cells_per_m]
    }

    /// Column and row of a cell.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "at most some thousands"
    )]
    pub(crate) fn column_and_row_of(&self, cell: usize) -> [i32; 2] {
        [(cell % self.columns) as i32, (cell / self.columns) as i32]
    }

    /// The cell in a column and a row, if there is one.
    #[inline]
    pub(crate) fn number(&self, column: i32, row: i32) -> Option<usize> {
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        (column < self.columns && row < self.rows).then_some(row * self.columns + column)
    }

    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "at most some thousands")]
    pub(crate) fn centre(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        self.area.min().plus(Point {
            x: (column as f64 + 0.5) * self.cell_m,
            y: (row as f64 + 0.5) * self.cell_m,
        })
    }

    /// Its lower left corner.
    pub(crate) fn corner(&self) -> Point {
        self.area.min()
    }

    /// Its width and height.
    pub(crate) fn size(&self) -> Point {
        self.area.size()
    }

    /// The position at an offset from its lower left corner.
    pub(crate) fn place(&self, [right_m, up_m]: [f64; 2]) -> Point {
        self.area.min().plus(Point {
            x: right_m,
            y: up_m,
        })
    }

    /// Distance of a position inside the field from its boundary.
    #[inline]
    pub(crate) fn edge_m(&self, position: Point) -> f64 {
        let (low, high) = (self.area.min().to(position), position.to(self.area.max()));
        low.x.min(low.y).min(high.x).min(high.y)
    }

    /// The position in the field that is nearest to another.
    pub(crate) fn nearest(&self, position: Point) -> Point {
        let (min, max) = (self.area.min(), self.area.max());
        Point {
            x: position.x.max(min.x).min(max.x),
            y: position.y.max(min.y).min(max.y),
        }
    }

    /// The cells on a straight line, without the first: one per column, or one per row if there are
    /// more rows.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "at most some thousands"
    )]
    pub(crate) fn crossed(&self, from: Point, to: Point) -> impl Iterator<Item = usize> + use<> {
        let ([right, up], [to_right, to_up]) = (self.in_cells(from), self.in_cells(to));
        let line = [to_right - right, to_up - up];
        let steps = line[0].abs().max(line[1].abs());
        let per_step = 1.0 / steps.max(f64::MIN_POSITIVE);
        let stride = line.map(|along| along * per_step);
        let count = match (self.cell(from), self.cell(to)) {
            (Some(_), Some(_)) => steps,
            (Some(_), None) => steps.min(self.steps_within([right, up], stride)),
            (None, _) => 0.0,
        };
        // A line to a point that is no number would have any number of cells.
        let most = (self.columns + self.rows) as f64;
        let count = if count.is_finite() {
            count.min(most) as u32
        } else {
            0
        };
        // Fixed-point numbers with 20 fractional bits: sums have no rounding errors.
        let fixed = |cells: f64| (cells * f64::from(1 << FRACTION_BITS)) as i64;
        let (mut at, stride) = ([fixed(right), fixed(up)], stride.map(fixed));
        let (columns, cells) = (self.columns as i64, self.cells());
        (0..count).map(move |_| {
            at = [at[0] + stride[0], at[1] + stride[1]];
            let cell = (at[1] >> FRACTION_BITS) * columns + (at[0] >> FRACTION_BITS);
            usize::try_from(cell).unwrap_or(cells)
        })
    }

    /// Number of strides from a position inside the field to its boundary.
    #[expect(clippy::cast_precision_loss, reason = "at most some thousands")]
    fn steps_within(&self, [right, up]: [f64; 2], stride: [f64; 2]) -> f64 {
        let within = |at: f64, stride: f64, count: usize| {
            let left = if stride > 0.0 { count as f64 - at } else { at };
            left / stride.abs().max(f64::MIN_POSITIVE)
        };
        within(right, stride[0], self.columns).min(within(up, stride[1], self.rows))
    }

    /// The cells within `reach` columns and rows of a cell, itself included.
    pub(crate) fn around(&self, cell: usize, reach: i32) -> impl Iterator<Item = usize> + use<> {
        let [column, row] = self.column_and_row_of(cell);
        let field = *self;
        let rows = row - reach..=row + reach;
        rows.flat_map(move |row| {
            let columns = column - reach..=column + reach;
            columns.filter_map(move |column| field.number(column, row))
        })
    }

    /// The cells along a direction of length 1, sampled every half cell; some occur twice.
    #[inline]
    pub(crate) fn along(
        &self,
        from: Point,
        direction: Point,
        length_m: f64,
    ) -> impl Iterator<Item = usize> + use<> {
        let [mut right, mut up] = self.in_cells(from);
        let (columns, rows) = (self.columns, self.rows);
        let count = 2.0 * length_m / self.cell_m;
        // Enough for the whole field.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a cast saturates"
        )]
        let count = (count as usize).min(4 * (columns + rows));
        (0..count).filter_map(move |_| {
            right += direction.x / 2.0;
            up += direction.y / 2.0;
            if right < 0.0 || up < 0.0 {
                return None;
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a cast saturates"
            )]
            let (column, row) = (right as usize, up as usize);
            (column < columns && row < rows).then(|| row * columns + column)
        })
    }

    /// The columns and rows that a box between two corners touches.
    pub(crate) fn columns_and_rows(&self, low: Point, high: Point) -> [Range<usize>; 2] {
        let ([left, bottom], [right, top]) = (self.column_and_row(low), self.column_and_row(high));
        let span = |first: i32, last: i32, count: usize| {
            let number = |number: i32| usize::try_from(number).unwrap_or(0).min(count);
            number(first)..number(last.saturating_add(1))
        };
        [
            span(left, right, self.columns),
            span(bottom, top, self.rows),
        ]
    }
}

/// The floor; faster than the library function on processors without an instruction for it.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
fn floor(number: f64) -> i32 {
    let towards_0 = number as i32;
    towards_0.saturating_sub(i32::from(number < f64::from(towards_0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_number_of_cells_is_limited_and_each_cell_contains_its_centre(
            width in -12_f64..7.0, height in -12_f64..7.0, max_cells in 4_usize..5000,
        ) {
            let [width, height] = [width, height].map(|exponent| libm::pow(10.0, exponent));
            let corner = Point { x: width, y: height };
            let field = Field::new(&Rectangle::spanned(Point::default(), corner), 0.25, max_cells);
            prop_assert!(field.cells() <= max_cells, "{field:?}");
            let last = field.cells() - 1;
            for cell in [0, last / 2, last] {
                prop_assert_eq!(field.cell(field.centre(cell)), Some(cell));
            }
            prop_assert_eq!(field.cell(Point { x: -0.1, y: 0.1 }), None);
        }
    }

    #[test]
    fn a_line_to_a_point_that_is_no_number_crosses_no_more_cells_than_the_field_has() {
        let corner = Point { x: 5.0, y: 5.0 };
        let field = Field::new(&Rectangle::spanned(Point::default(), corner), 1.0, 1000);
        let from = Point { x: 2.0, y: 2.0 };
        for (x, y) in [(f64::NAN, 1e300), (1e300, f64::NAN), (-1e308, 1e308)] {
            assert!(field.crossed(from, Point { x, y }).count() <= 10, "{x} {y}");
        }
    }

    #[test]
    fn columns_and_rows_of_a_box_are_those_that_it_touches() {
        let corner = Point { x: 5.0, y: 5.0 };
        let field = Field::new(&Rectangle::spanned(Point::default(), corner), 1.0, 1000);
        let (low, high) = (Point { x: -0.1, y: 4.0 }, Point { x: 1.1, y: 9.0 });
        assert_eq!(field.columns_and_rows(low, high), [0..2, 4..5]);
        let beyond = Point { x: 6.0, y: 6.0 };
        let [columns, rows] = field.columns_and_rows(beyond, high);
        assert!(columns.is_empty() && rows.is_empty());
    }
}
