//! Six definitions of finding an item. In the original experiment, a person judged it by eye.

use crate::heading::Heading;
use crate::world::{self, Cell, ITEMS};
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::LazyLock;

/// What counts as contact between a robot and an item.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Contact {
    /// The item is on one of the eight cells around the robot, or on its own cell.
    Neighbour,
    /// The item is on a diagonal neighbour or on the robot's own cell, as for a robot's colour.
    Diagonal,
    /// At most two columns and two rows away.
    Within2,
    /// At most three columns and three rows away.
    Within3,
    /// The drawn robot touches the drawn item; judged at every paint.
    Touch,
    /// The item is on one of the three neighbouring cells at which the robot looks.
    Ahead,
}

impl Contact {
    /// Every definition with its name in scenarios.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("neighbour", Self::Neighbour),
        ("diagonal", Self::Diagonal),
        ("within-2", Self::Within2),
        ("within-3", Self::Within3),
        ("touch", Self::Touch),
        ("ahead", Self::Ahead),
    ];

    /// Whether it is judged at every paint instead of at decisions only.
    pub(crate) fn is_by_paint(self) -> bool {
        self == Self::Touch
    }

    /// The cells on which a robot can be in contact with `item`, for any heading; empty for
    /// [`Contact::Touch`].
    #[must_use]
    pub fn cells(self, item: Cell) -> Vec<Cell> {
        let holds =
            |cell: &Cell| (0..8).any(|octant| self.holds(*cell, Heading::of_octant(octant), item));
        world::cells().filter(holds).collect()
    }

    /// Whether a robot on `cell` with the heading `looking` is in contact with `item`.
    ///
    /// `looking` is the heading before the decision's turn. [`Contact::Touch`] is not
    /// defined on cells: see [`Pose::touches`].
    pub(crate) fn holds(self, cell: Cell, looking: Heading, item: Cell) -> bool {
        let (dx, dy) = cell.gaps(item);
        match self {
            Self::Neighbour => dx.max(dy) <= 1,
            Self::Diagonal => dx == dy && dx <= 1,
            Self::Within2 => dx.max(dy) <= 2,
            Self::Within3 => dx.max(dy) <= 3,
            // A robot on the frame or outside does not look at its neighbouring cells.
            Self::Ahead => {
                let looks = looking.looks().map(|step| cell.ahead(step, 1));
                cell.is_inside(1) && looks.contains(&item)
            }
            Self::Touch => false,
        }
    }
}

/// The items that have been found, one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Found(pub(crate) u8);

impl Found {
    pub(crate) const ALL: Self = Self(0b1111);

    /// The items for which `holds`.
    pub(crate) fn of(mut holds: impl FnMut(Cell) -> bool) -> Self {
        let bits = ITEMS.into_iter().enumerate();
        Self(bits.fold(0, |found, (bit, item)| {
            found | (u8::from(holds(item)) << bit)
        }))
    }

    pub(crate) fn has(self, bit: usize) -> bool {
        self.0 >> bit & 1 == 1
    }

    pub(crate) fn count(self) -> u8 {
        // At most four.
        self.0.count_ones().to_le_bytes()[0]
    }
}

impl std::ops::BitOrAssign for Found {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// The pose in which a robot is drawn, in 64-bit floats.
///
/// It starts from the cell of the last decision, and leaves out the tiny sideways drift of the
/// original's 32-bit moves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    x_px: f64,
    y_px: f64,
    right: (f64, f64),
    back: (f64, f64),
}

/// Sines of the eight octants. The sine of the platform differs between machines.
const SINES: [f64; 8] = [
    0.0,
    FRAC_1_SQRT_2,
    1.0,
    FRAC_1_SQRT_2,
    0.0,
    -FRAC_1_SQRT_2,
    -1.0,
    -FRAC_1_SQRT_2,
];

const PX_PER_PAINT: f64 = 2.0;
const ITEM_PX: f64 = 20.0;

/// The chevron as drawn: three strokes of 25 points, in the robot's frame (right, back), px.
static CHEVRON: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let strokes = [
        [(0.0, -8.0), (0.0, 16.0)],
        [(0.0, 4.0), (-8.0, 10.0)],
        [(0.0, 4.0), (8.0, 10.0)],
    ];
    let points = |[(x0, y0), (x1, y1)]: [(f64, f64); 2]| {
        (0..25).map(move |k| {
            let along = f64::from(k) / 24.0;
            (x0 + along * (x1 - x0), y0 + along * (y1 - y0))
        })
    };
    strokes.into_iter().flat_map(points).collect()
});

impl Pose {
    /// The pose of a robot `paints` after a decision at these pixels.
    pub(crate) fn new(px: (f64, f64), heading: Heading, speed: u8, paints: u8) -> Self {
        let octant = heading.octant();
        let (sine, cosine) = (SINES[octant], SINES[(octant + 2) % 8]);
        let travelled_px = f64::from(paints) * PX_PER_PAINT * f64::from(speed);
        Self {
            x_px: px.0 + travelled_px * sine,
            y_px: px.1 - travelled_px * cosine,
            right: (cosine, sine),
            back: (-sine, cosine),
        }
    }

    /// Whether any point of the chevron is on the closed square of `item`.
    pub(crate) fn touches(&self, item: Cell) -> bool {
        let (left, top) = (f64::from(item.x) * ITEM_PX, f64::from(item.y) * ITEM_PX);
        CHEVRON.iter().any(|(right, back)| {
            let x = self.x_px + right * self.right.0 + back * self.back.0;
            let y = self.y_px + right * self.right.1 + back * self.back.1;
            (left..=left + ITEM_PX).contains(&x) && (top..=top + ITEM_PX).contains(&y)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ITEM: Cell = Cell { x: 9, y: 5 };

    /// How many cells of the grid are in contact with one item, for a robot that looks up.
    fn cells_in_contact(contact: Contact) -> Vec<(i32, i32)> {
        let up = Heading::of_octant(0);
        crate::world::cells()
            .filter(|cell| contact.holds(*cell, up, ITEM))
            .map(|cell| (cell.x - ITEM.x, cell.y - ITEM.y))
            .collect()
    }

    #[test]
    fn definitions_on_cells_hold_on_the_cells_that_their_names_say() {
        assert_eq!(cells_in_contact(Contact::Neighbour).len(), 9);
        assert_eq!(cells_in_contact(Contact::Within2).len(), 25);
        assert_eq!(cells_in_contact(Contact::Within3).len(), 49);
        let diagonal = [(-1, -1), (-1, 1), (0, 0), (1, -1), (1, 1)];
        assert_eq!(cells_in_contact(Contact::Diagonal), diagonal);
        // Looking up, the item is above and to the left, above, or above and to the right.
        assert_eq!(cells_in_contact(Contact::Ahead), [(-1, 1), (0, 1), (1, 1)]);
    }

    #[test]
    fn cells_of_contact_are_those_where_any_heading_gives_it() {
        assert_eq!(Contact::Neighbour.cells(ITEM).len(), 9);
        assert_eq!(Contact::Ahead.cells(ITEM).len(), 8);
        assert_eq!(Contact::Touch.cells(ITEM), []);
    }

    #[test]
    fn a_robot_on_the_frame_does_not_look_ahead() {
        let right = Heading::of_octant(2);
        let beside = |x| Contact::Ahead.holds(Cell { x, y: 8 }, right, Cell { x: x + 1, y: 8 });
        assert!(beside(1));
        assert!(!beside(0));
    }

    fn touches(x_px: f64, y_px: f64, octant: usize, paints: u8) -> bool {
        Pose::new((x_px, y_px), Heading::of_octant(octant), 1, paints).touches(ITEM)
    }

    #[test]
    fn the_drawn_robot_touches_the_closed_square_of_the_item() {
        // The item covers 180 to 200 px to the right and 100 to 120 px down. A robot that heads up
        // has its nose 8 px above its place, its tail 16 px below, its fins 8 px to either side.
        assert!(touches(190.0, 128.0, 0, 0), "the nose on the lower edge");
        assert!(
            !touches(190.0, 128.5, 0, 0),
            "the nose below the lower edge"
        );
        assert!(touches(190.0, 84.0, 0, 0), "the tail on the upper edge");
        assert!(!touches(190.0, 83.5, 0, 0), "the tail above the upper edge");
        assert!(
            touches(172.0, 100.0, 0, 0),
            "the right fin on the left edge"
        );
        assert!(
            !touches(171.5, 100.0, 0, 0),
            "the right fin left of the left edge"
        );
        assert!(
            touches(200.0, 110.0, 0, 0),
            "the middle stroke on the right edge"
        );
    }

    #[test]
    fn a_robot_moves_two_pixels_a_paint_along_its_heading() {
        assert!(!touches(160.0, 110.0, 2, 5), "heading right: nose at 178");
        assert!(touches(160.0, 110.0, 2, 6), "nose at 180, the left edge");
        let diagonal = FRAC_1_SQRT_2 * (8.0 + 2.0 * 5.0);
        assert!(
            touches(181.0 - diagonal, 119.0 + diagonal, 1, 5),
            "up and right"
        );
    }
}
