//! The shortest way around what is known to be filled.
//!
//! A wave runs from a place over all cells that the body fits into (Dijkstra, *A note on two problems in
//! connexion with graphs*, 1959, with whole numbers: 5 a step, 7 a step aslant); a robot goes down it as
//! far as it sees a straight way. What is unknown counts as free.
//!
//! Who stands, or wants to be, where the body does not fit, as next to a wall, goes straight between there
//! and the nearest cells where it does, if nothing filled lies between.

use crate::perception::beliefs::field::Field;
use crate::perception::beliefs::occupancy::Occupancy;
use alloc::vec::Vec;
use base::geometry::Point;

/// A step along a row or a column, and one aslant; 7 / 5 is near the square root of 2.
const STRAIGHT: u16 = 5;
const ASLANT: u16 = 7;

/// The body does not fit into a cell: no wave ever runs over what is nearer.
const SHUT: u16 = 0;

/// Where a wave begins.
const BEGIN: u16 = 1;

/// No wave has come to a cell.
const NEVER: u16 = u16::MAX;

/// Waves end here: no way on a field of some thousand cells is longer, but for mazes.
const FARTHEST: u16 = NEVER - ASLANT;

/// How far every cell is from one place. Two bytes a cell and four for the wave.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wave {
    from: Point,
    /// Row by row, with a shut cell before each row and a shut row before and after all.
    fifths: Vec<u16>,
    /// From a cell to the one above it.
    stride: usize,
    /// In cells: so far off there is room beside what is filled.
    reach: i32,
    /// Cells to go on from, by what is left of their cost modulo 8.
    fronts: [Vec<u32>; 8],
    is_whole: bool,
}

impl Wave {
    /// Lets a wave run from `from`; a body that needs so much room to all sides must fit.
    ///
    /// `goes_on` is asked for each cell that the wave comes to, with how far that is, the nearest first.
    pub(crate) fn run(
        &mut self,
        (field, map): (&Field, &Occupancy),
        from: Point,
        room_m: f64,
        goes_on: impl FnMut(usize, f64) -> bool,
    ) {
        self.from = from;
        self.stride = field.columns + 1;
        self.open(field);
        self.shut(field, map, room_m);
        self.begin(field, map);
        self.is_whole = self.spread(field, goes_on);
    }

    /// Opens all cells but those around the field.
    fn open(&mut self, field: &Field) {
        self.fifths.clear();
        self.fifths.resize(self.stride, SHUT);
        for _ in 0..field.rows {
            self.fifths.push(SHUT);
            let row = self.fifths.len() + field.columns;
            self.fifths.resize(row, NEVER);
        }
        self.fifths.resize((field.rows + 2) * self.stride + 1, SHUT);
    }

    /// Shuts the cells that a body does not fit into.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "at most some thousands"
    )]
    fn shut(&mut self, field: &Field, map: &Occupancy, room_m: f64) {
        let most = field.columns.max(field.rows) as f64;
        let room = (room_m / field.cell_m).max(0.0).min(most);
        self.reach = room as i32 + 1;
        for filled in map.filled() {
            let [column, row] = field.column_and_row_of(filled);
            for up in 1 - self.reach..self.reach {
                for right in 1 - self.reach..self.reach {
                    let is_near = f64::from(right * right + up * up) <= room * room;
                    if let Some(cell) = field.number(column + right, row + up)
                        && is_near
                    {
                        let place = self.place(field, cell);
                        self.fifths[place] = SHUT;
                    }
                }
            }
        }
    }

    fn begin(&mut self, field: &Field, map: &Occupancy) {
        self.fronts.iter_mut().for_each(Vec::clear);
        let first = field.nearest_cell(self.from);
        if !self.is_shut(field, first) {
            let place = self.place(field, first);
            self.reach_at(place, BEGIN);
            return;
        }
        let from = self.from;
        for cell in field.around(first, self.reach + 1) {
            let is_open = !self.is_shut(field, cell);
            if is_open && leads(field, map, field.centre(cell), from) {
                let place = self.place(field, cell);
                self.reach_at(place, BEGIN);
            }
        }
    }

    /// Whether it comes to all that it can.
    fn spread(&mut self, field: &Field, mut goes_on: impl FnMut(usize, f64) -> bool) -> bool {
        let (mut cost, mut empty) = (BEGIN, 0);
        while empty < 8 && cost < FARTHEST {
            let mut front = core::mem::take(&mut self.fronts[usize::from(cost % 8)]);
            empty = if front.is_empty() { empty + 1 } else { 0 };
            let way_m = way_m(field, cost);
            for place in front.iter().map(|place| *place as usize) {
                if self.fifths[place] == cost {
                    self.go_on(place, cost);
                    let (row, column) = (place / self.stride - 1, place % self.stride - 1);
                    if !goes_on(row * field.columns + column, way_m) {
                        return false;
                    }
                }
            }
            // Its room is used again.
            front.clear();
            self.fronts[usize::from(cost % 8)] = front;
            cost += 1;
        }
        true
    }

    #[inline]
    fn go_on(&mut self, place: usize, cost: u16) {
        let (up, down) = (place + self.stride, place - self.stride);
        for next in [place + 1, place - 1, up, down] {
            if self.fifths[next] > cost + STRAIGHT {
                self.reach_at(next, cost + STRAIGHT);
            }
        }
        for (row, side) in [(up, 1), (up, -1), (down, 1), (down, -1)] {
            let next = row.wrapping_add_signed(side);
            if self.fifths[next] > cost + ASLANT && !self.is_crack(row, place, side) {
                self.reach_at(next, cost + ASLANT);
            }
        }
    }

    /// Whether a step aslant, by way of a row and to a side, would pass between two shut cells.
    #[inline]
    fn is_crack(&self, row: usize, place: usize, side: isize) -> bool {
        self.fifths[row] == SHUT && self.fifths[place.wrapping_add_signed(side)] == SHUT
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "at most 65,000 cells")]
    fn reach_at(&mut self, place: usize, cost: u16) {
        self.fifths[place] = cost;
        self.fronts[usize::from(cost % 8)].push(place as u32);
    }

    /// Where a cell of the field is among all.
    #[inline]
    fn place(&self, field: &Field, cell: usize) -> usize {
        let (column, row) = (cell % field.columns, cell / field.columns);
        (row + 1) * self.stride + column + 1
    }

    /// Whether it has come to a place, or is known never to.
    pub(crate) fn knows(&self, field: &Field, place: Point) -> bool {
        let cell = field.nearest_cell(place);
        self.is_whole || (!self.fifths.is_empty() && self.cell_distance_m(field, cell).is_some())
    }

    /// Whether a body does not fit into a cell.
    #[inline]
    pub(crate) fn is_shut(&self, field: &Field, cell: usize) -> bool {
        self.fifths[self.place(field, cell)] == SHUT
    }

    /// How far a cell is by the way; `None` if there is none, or the body does not fit into it.
    #[inline]
    pub(crate) fn cell_distance_m(&self, field: &Field, cell: usize) -> Option<f64> {
        let fifths = self.fifths[self.place(field, cell)];
        let is_way = fifths != SHUT && fifths != NEVER;
        is_way.then(|| way_m(field, fifths))
    }

    /// The nearest cell of all to which a straight way leads from a place that the body does not fit into,
    /// and how far that place is by way of it.
    pub(crate) fn out_of(
        &self,
        field: &Field,
        map: &Occupancy,
        place: Point,
    ) -> Option<(usize, f64)> {
        let cells = field.around(field.nearest_cell(place), self.reach + 1);
        let distances = cells.filter_map(|cell| {
            let centre = field.centre(cell);
            let way_m = self.cell_distance_m(field, cell)? + centre.to(place).length();
            leads(field, map, centre, place).then_some((cell, way_m))
        });
        distances.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// The next cell on the way from one to where the wave began; `None` there.
    fn next(&self, field: &Field, cell: usize) -> Option<usize> {
        let place = self.place(field, cell);
        let [column, row] = field.column_and_row_of(cell);
        let (up, down) = (place + self.stride, place - self.stride);
        let straight = [
            (1, 0, place + 1),
            (-1, 0, place - 1),
            (0, 1, up),
            (0, -1, down),
        ];
        let aslant = [(1, 1, up), (-1, 1, up), (1, -1, down), (-1, -1, down)];
        let aslant = aslant
            .into_iter()
            .filter(|(side, _, row)| !self.is_crack(*row, place, *side as isize))
            .map(|(side, level, row)| {
                (side, level, row.wrapping_add_signed(side as isize), ASLANT)
            });
        let straight = straight
            .into_iter()
            .map(|(side, level, next)| (side, level, next, STRAIGHT));
        let all = straight
            .chain(aslant)
            .filter_map(|(side, level, next, step)| {
                let fifths = self.fifths[next];
                let cell = field.number(column + side, row + level)?;
                (fifths != SHUT).then(|| (fifths.saturating_add(step), cell, fifths))
            });
        let (_, next, fifths) = all.min()?;
        (fifths < self.fifths[place]).then_some(next)
    }

    /// The farthest place on the way from `from` that lies straight ahead; `None` if there is no way.
    pub(crate) fn ahead(&self, field: &Field, map: &Occupancy, from: Point) -> Option<Point> {
        let mut cell = field.nearest_cell(from);
        let Some(_) = self.cell_distance_m(field, cell) else {
            let (out, _) = self.out_of(field, map, from)?;
            return Some(field.centre(out));
        };
        let mut seen = None;
        while let Some(next) = self.next(field, cell) {
            let place = field.centre(next);
            if seen.is_some() && !self.is_open_between(field, from, place) {
                break;
            }
            (seen, cell) = (Some(place), next);
        }
        // From where the wave began, the rest is straight.
        Some(seen.unwrap_or(self.from))
    }

    /// Whether the body fits through on the straight way between two places.
    pub(crate) fn is_open_between(&self, field: &Field, from: Point, to: Point) -> bool {
        let way = from.to(to);
        let length_m = way.length();
        let direction = way.times(1.0 / length_m.max(f64::MIN_POSITIVE));
        !field
            .along(from, direction, length_m)
            .any(|cell| self.is_shut(field, cell))
    }
}

/// The way that costs so much.
#[inline]
fn way_m(field: &Field, fifths: u16) -> f64 {
    f64::from(fifths - BEGIN) / f64::from(STRAIGHT) * field.cell_m
}

/// Whether nothing lies between an open cell and a place near it, which may be filled itself.
fn leads(field: &Field, map: &Occupancy, open: Point, place: Point) -> bool {
    if map.is_filled(field.nearest_cell(place)) {
        map.sees(field, open, place, 0.0)
    } else {
        map.is_free_between(field, open, place)
    }
}

#[cfg(test)]
mod tests;
