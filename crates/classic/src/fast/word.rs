//! A robot of the fast form, packed into one word: a decision is one table lookup and one addition.
//!
//! ```text
//! bits 31..29   28     27..24   23..20           19..16          15..10   9..0
//!     octant   speed   unused   right turns + 3  left turns + 3  unused   position
//! ```
//!
//! * Position is `x * 32 + y`.
//! * Turns are stored with an offset of 3, so that bit 3 of the field means "more than four".
//! * The octant is on top, so that adding and subtracting one wraps around.
//! * Speed is 0 or 1: from these, no robot reaches 2 (see [`super::tables`]).

use crate::world::Cell;

pub(super) type Word = u32;

pub(super) const STRIDE: u16 = 32;
/// Positions, and the length of every table by position; masking with `POSITIONS - 1` keeps an
/// index in bounds without a check.
pub(super) const POSITIONS: usize = 1024;

const POSITION_MASK: Word = 0x3ff;
pub(super) const LEFT_TURN: Word = 1 << 16;
pub(super) const RIGHT_TURN: Word = 1 << 20;
pub(super) const SPEED: Word = 1 << 28;
pub(super) const OCTANT: Word = 1 << 29;
const TURNS_BIAS: Word = 3;

/// Robot `index` at the start of a run: heading 45 degrees x index, speed 1, no turns.
#[inline]
pub(super) fn start(cell: Cell, index: u32) -> Word {
    let turns = TURNS_BIAS * (LEFT_TURN + RIGHT_TURN);
    index.wrapping_mul(OCTANT) | SPEED | turns | Word::from(position_of(cell))
}

/// The position of a cell of the grid.
#[inline]
pub(super) fn position_of(cell: Cell) -> u16 {
    // Exact for the cells 0..25 of the grid, the only ones a robot of the fast form is ever on.
    let index = cell.x * i32::from(STRIDE) + cell.y;
    (index.cast_unsigned() & POSITION_MASK) as u16
}

/// Index by position.
#[inline]
pub(super) fn position(word: Word) -> usize {
    (word & POSITION_MASK) as usize
}

/// Index by octant and speed, 0 to 15.
#[inline]
pub(super) fn motion(word: Word) -> usize {
    (word >> 28) as usize
}

/// 0 or 1.
#[inline]
pub(super) fn speed(word: Word) -> usize {
    motion(word) & 1
}

/// The cell of a robot.
pub(super) fn cell(word: Word) -> Cell {
    let position = (word & POSITION_MASK).cast_signed();
    Cell {
        x: position / i32::from(STRIDE),
        y: position % i32::from(STRIDE),
    }
}

/// The position a step further on, modulo 2^16.
#[inline]
pub(super) fn position_after(word: Word, step: u16) -> u16 {
    ((word & POSITION_MASK) as u16).wrapping_add(step)
}

/// Index of the position `offset` away from another.
#[inline]
pub(super) fn offset(position: u16, offset: u16) -> usize {
    usize::from(position.wrapping_add(offset)) & (POSITIONS - 1)
}

/// The robot on another position.
#[inline]
pub(super) fn moved_to(word: Word, position: u16) -> Word {
    (word & !POSITION_MASK) | (Word::from(position) & POSITION_MASK)
}

/// The robot at speed 0.
#[inline]
pub(super) fn stopped(word: Word) -> Word {
    word & !SPEED
}

/// 1 for more than four left turns, 2 for more than four right turns.
#[inline]
pub(super) fn circling(word: Word) -> usize {
    let left = (word >> 19) & 1;
    let right = (word >> 22) & 2;
    (left | right) as usize
}
