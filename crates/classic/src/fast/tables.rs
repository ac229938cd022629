//! The lookup tables of the fast form, all derived from the rules of the plain form.
//!
//! Two of the rules are not needed, because a robot that starts at speed 0 or 1 never reaches speed 2:
//! a fast score is at most its slow one when both begin equal and the current speed is not 2, it
//! comes later in the order, and where the circling penalty lifts it above (left: -2 and -1) the
//! stop's 0 is higher still. So the look at distance 2, which only changes fast scores, never decides;
//! only its bonus for continuing at speed 1 remains, on the cells where it applies.

use super::word::{self, LEFT_TURN, OCTANT, POSITIONS, RIGHT_TURN, SPEED, STRIDE, Word};
use crate::clock::{DECISION_PERIOD, FIRST_DECISION};
use crate::contact::{Contact, Found, Pose};
use crate::heading::Heading;
use crate::world::{Cell, cells};
use std::sync::{LazyLock, OnceLock};

pub(super) type Grid = [u8; POSITIONS];

/// Offsets of position (modulo 2^16) for each [`word::motion`].
#[derive(Clone, Copy, Default)]
pub(super) struct Motion {
    /// One period's move.
    pub(super) step: u16,
    /// The cells to the left, ahead and to the right.
    pub(super) looks: [u16; 3],
}

/// A robot's action, given its view and its past turns; see [`Tables::rules`].
#[derive(Clone, Copy, Default)]
pub(super) struct Rule {
    /// The next carry is `(carry & keep) + add`: the left-slow score.
    pub(super) keep: i32,
    /// See `keep`.
    pub(super) add: i32,
    /// The robot goes left if its left-slow score is at least this, the best of the others.
    pub(super) threshold: i32,
    /// Added to the robot's word: if it does not go left, and if it does.
    pub(super) change: [Word; 2],
}

/// The tables that do not depend on the contact definition.
pub(super) struct Tables {
    /// Static content; empty outside the 25 x 25 cells.
    pub(super) grid: Grid,
    /// By [`word::motion`].
    pub(super) motions: [Motion; 16],
    /// 1 where the robot looks at distance 2: at least two cells from the edge.
    pub(super) is_inner: [u8; POSITIONS],
    /// By filled cells (left 1, ahead 2, right 4), [`word::circling`] (from bit 3) and bonus (bit 5).
    pub(super) rules: [Rule; 64],
}

pub(super) static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    grid: by_position(|cell| u8::from(cell.is_static())),
    motions: std::array::from_fn(motion),
    is_inner: by_position(|cell| u8::from(cell.is_inside(2))),
    rules: std::array::from_fn(rule),
});

fn by_position(value: impl Fn(Cell) -> u8) -> [u8; POSITIONS] {
    let mut table = [0; POSITIONS];
    for cell in cells() {
        table[usize::from(word::position_of(cell))] = value(cell);
    }
    table
}

fn motion(index: usize) -> Motion {
    let heading = Heading::of_octant(index / 2);
    let offset = |(right, down): (i32, i32)| {
        let offset = right * i32::from(STRIDE) + down;
        // Two's complement: added modulo 2^16.
        (offset.cast_unsigned() & 0xffff) as u16
    };
    Motion {
        step: if index % 2 == 1 {
            offset(heading.step())
        } else {
            0
        },
        looks: heading.looks().map(offset),
    }
}

fn rule(index: usize) -> Rule {
    let is = |bit: usize| index & bit != 0;
    let [left_filled, ahead_filled, right_filled] = [is(1), is(2), is(4)];
    let [left_circling, right_circling] = [is(8), is(16)];
    let bonus = i32::from(is(32));
    let look = |filled: bool| if filled { -5 } else { 0 };
    let circling_score = -2;

    let (keep, add) = match (left_circling, left_filled) {
        (true, _) => (0, circling_score),
        (false, true) => (0, look(true) + bonus + 1),
        (false, false) => (-1, bonus + 1),
    };
    let ahead = look(ahead_filled) + bonus;
    let right = if right_circling {
        circling_score
    } else {
        look(right_filled) + bonus + 1
    };

    let five_to_three = |is_circling: bool, turn: Word| if is_circling { 2 * turn } else { 0 };
    let penalty =
        five_to_three(left_circling, LEFT_TURN) + five_to_three(right_circling, RIGHT_TURN);
    let go_left = LEFT_TURN.wrapping_sub(OCTANT).wrapping_sub(penalty);
    let go_right = (RIGHT_TURN + OCTANT).wrapping_sub(penalty);
    let go_ahead = 0u32.wrapping_sub(penalty);
    let (threshold, otherwise) = if ahead >= right && ahead >= 0 {
        (ahead, go_ahead.wrapping_add(SPEED))
    } else if right >= 0 {
        (right, go_right.wrapping_add(SPEED))
    } else {
        (0, go_left)
    };
    Rule {
        keep,
        add,
        threshold,
        change: [otherwise, go_left.wrapping_add(SPEED)],
    }
}

/// The items that a robot finds, by its motion and position: at the decision, or for
/// [`Contact::Touch`] in the period that follows it.
pub(super) type Finds = [[u8; POSITIONS]; 16];

/// The finds of one contact definition.
pub(super) struct ContactTables {
    /// At a decision.
    pub(super) decision: Finds,
    /// At the start: [`Contact::Touch`] then has a longer period before it.
    pub(super) start: Finds,
}

/// The tables of a definition, computed once.
pub(super) fn contact_tables(contact: Contact) -> &'static ContactTables {
    static ALL: [OnceLock<ContactTables>; Contact::NAMES.len()] =
        [const { OnceLock::new() }; Contact::NAMES.len()];
    ALL[contact as usize].get_or_init(|| make_contact_tables(contact))
}

fn make_contact_tables(contact: Contact) -> ContactTables {
    let finds = |paints: u64| {
        let find = |motion: usize, cell: Cell| {
            Found::of(|item| {
                if contact.is_by_paint() {
                    first_touch(cell, motion, item, paints).is_some()
                } else {
                    contact.holds(cell, Heading::of_octant(motion / 2), item)
                }
            })
        };
        std::array::from_fn(|motion| by_position(|cell| find(motion, cell).0))
    };
    ContactTables {
        decision: finds(DECISION_PERIOD),
        start: finds(FIRST_DECISION),
    }
}

/// Paints after a decision until a robot touches an item, if it does in fewer than `period`.
pub(super) fn first_touch(cell: Cell, motion: usize, item: Cell, period: u64) -> Option<u64> {
    let (dx, dy) = cell.gaps(item);
    // At most 24 px of travel, 16 px of chevron and 20 px of item: under four cells.
    if dx.max(dy) > 3 {
        return None;
    }
    let px = (f64::from(cell.x) * 20.0, f64::from(cell.y) * 20.0);
    let heading = Heading::of_octant(motion / 2);
    let speed = u8::from(motion % 2 == 1);
    (0..period).find(|paints| {
        let paints = paints.to_le_bytes()[0];
        Pose::new(px, heading, speed, paints).touches(item)
    })
}
