//! The mission's field in cells.

use base::geometry::{Point, Rectangle};

/// A rectangle of square cells, row by row from the least corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field {
    area: Rectangle,
    pub(crate) cell_m: f64,
    cells_a_m: f64,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Field {
    /// Cells over `area`, as small as `least_cell_m` if that makes no more than `most` of them.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "at most some thousands"
    )]
    pub(crate) fn new(area: &Rectangle, least_cell_m: f64, most: usize) -> Self {
        let size = area.size();
        // (width / cell + 1) (height / cell + 1) = most, since both are rounded up.
        let (sum_m, area_m2) = (size.x + size.y, size.x * size.y);
        let root = libm::sqrt(sum_m * sum_m + 4.0 * area_m2 * (most.max(4) as f64 - 1.0));
        let sparse_m = 2.0 * area_m2 / (root - sum_m);
        let cell_m = least_cell_m.max(sparse_m);
        let count = |length_m: f64| (libm::ceil(length_m / cell_m) as usize).max(1);
        Self {
            area: *area,
            cell_m,
            cells_a_m: 1.0 / cell_m,
            columns: count(size.x),
            rows: count(size.y),
        }
    }

    pub(crate) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The cell that holds a place, if one does.
    #[inline]
    pub(crate) fn cell(&self, place: Point) -> Option<usize> {
        let [column, row] = self.column_and_row(place);
        self.number(column, row)
    }

    /// The cell nearest to a place.
    pub(crate) fn nearest_cell(&self, place: Point) -> usize {
        let [column, row] = self.column_and_row(place);
        let within =
            |number: i32, count: usize| usize::try_from(number).unwrap_or(0).min(count - 1);
        within(row, self.rows) * self.columns + within(column, self.columns)
    }

    /// Column and row of a place, also beyond the edges.
    #[inline]
    pub(crate) fn column_and_row(&self, place: Point) -> [i32; 2] {
        let [right, up] = self.in_cells(place);
        [whole(right), whole(up)]
    }

    /// A place as so many cells from the least corner.
    #[inline]
    pub(crate) fn in_cells(&self, place: Point) -> [f64; 2] {
        let way = self.area.min().to(place);
        [way.x * self.cells_a_m, way.y * self.cells_a_m]
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

    /// Its width and height.
    pub(crate) fn size(&self) -> Point {
        self.area.size()
    }

    /// The place so far to the right of its least corner, and so far up.
    pub(crate) fn place(&self, [right_m, up_m]: [f64; 2]) -> Point {
        self.area.min().plus(Point {
            x: right_m,
            y: up_m,
        })
    }

    /// Whether it holds a place.
    pub(crate) fn holds(&self, place: Point) -> bool {
        self.area.contains(place)
    }

    /// Cells whose columns and rows come near a place.
    pub(crate) fn about(&self, place: Point, radius_m: f64) -> impl Iterator<Item = usize> + use<> {
        let corner = Point {
            x: radius_m,
            y: radius_m,
        };
        let [left, low] = self.column_and_row(corner.to(place));
        let [right, high] = self.column_and_row(place.plus(corner));
        let field = *self;
        let most = |count: usize| i32::try_from(count).unwrap_or(i32::MAX) - 1;
        let columns = left.max(0)..=right.min(most(self.columns));
        (low.max(0)..=high.min(most(self.rows)))
            .flat_map(move |row| columns.clone().map(move |column| (column, row)))
            .filter_map(move |(column, row)| field.number(column, row))
    }
}

/// The greatest whole number that is no more; faster than the library's without help of the processor.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
fn whole(number: f64) -> i32 {
    let towards_0 = number as i32;
    towards_0.saturating_sub(i32::from(number < f64::from(towards_0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn there_are_never_more_cells_than_allowed_and_each_holds_its_centre(
            width in 0.1_f64..1e5, height in 0.1_f64..1e5, most in 4_usize..5000,
        ) {
            let corner = Point { x: width, y: height };
            let field = Field::new(&Rectangle::spanned(Point::default(), corner), 0.25, most);
            prop_assert!(field.cells() <= most, "{field:?}");
            let last = field.cells() - 1;
            for cell in [0, last / 2, last] {
                prop_assert_eq!(field.cell(field.centre(cell)), Some(cell));
            }
            prop_assert_eq!(field.cell(Point { x: -0.1, y: 0.1 }), None);
        }
    }

    #[test]
    fn cells_about_a_place_are_those_that_come_near_it() {
        let corner = Point { x: 5.0, y: 5.0 };
        let field = Field::new(&Rectangle::spanned(Point::default(), corner), 1.0, 1000);
        let about: Vec<usize> = field.about(Point { x: 0.5, y: 4.6 }, 0.6).collect();
        assert_eq!(about, [15, 16, 20, 21]);
    }
}
