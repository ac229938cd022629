//! Compass headings in steps of 45 degrees.

use std::f32::consts::SQRT_2;

/// A compass heading in degrees: one of 0 (up), 45, 90 (right), ..., 315, 360.
///
/// 0 and 360 point the same way but are different values, as in the original: turning right from
/// 315 gives 360 and then 45; turning left from 45 gives 0 and then 315.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Heading(u16);

/// A robot's turn at a decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turn {
    Left,
    None,
    Right,
}

/// One 32-bit move per octant at speed 1, in pixels per paint, exactly as computed by the original's
/// sine and cosine (hence the tiny values, which only matter while a coordinate is 0).
const MOVES_PX: [(f32, f32); 8] = [
    (1.224_646_9e-16, -2.0),
    (SQRT_2, -SQRT_2),
    (2.0, 0.0),
    (SQRT_2, SQRT_2),
    (-3.673_940_3e-16, 2.0),
    (-SQRT_2, SQRT_2),
    (-2.0, -2.449_293_7e-16),
    (-SQRT_2, -SQRT_2),
];

/// Cells (right, down) that one step along each octant crosses; a diagonal step crosses both ways.
const STEPS: [(i32, i32); 8] = [
    (0, -1),
    (1, -1),
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
];

impl Heading {
    /// The heading of an octant, 0 (up) to 7, clockwise; larger numbers wrap around.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below 8")]
    pub fn of_octant(octant: usize) -> Self {
        Self((octant % 8) as u16 * 45)
    }

    /// Degrees, 0 to 360.
    #[must_use]
    pub fn degrees(self) -> u16 {
        self.0
    }

    /// The direction as an octant, 0 (up) to 7, clockwise.
    #[must_use]
    pub fn octant(self) -> usize {
        usize::from(self.0 / 45 % 8)
    }

    pub(crate) fn turned(self, turn: Turn) -> Self {
        match turn {
            Turn::Left if self.0 < 45 => Self(self.0 + 360 - 45),
            Turn::Left => Self(self.0 - 45),
            Turn::None => self,
            Turn::Right if self.0 + 45 > 360 => Self(self.0 + 45 - 360),
            Turn::Right => Self(self.0 + 45),
        }
    }

    /// Pixels (right, down) moved in one paint at speed 1.
    pub(crate) fn move_px(self) -> (f32, f32) {
        MOVES_PX[self.octant()]
    }

    /// Cells (right, down) of one step ahead.
    pub(crate) fn step(self) -> (i32, i32) {
        STEPS[self.octant()]
    }

    /// Steps to the left, ahead and to the right: heading - 45, heading, heading + 45 degrees.
    pub(crate) fn looks(self) -> [(i32, i32); 3] {
        [7, 0, 1].map(|turn| STEPS[(self.octant() + turn) % 8])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_are_the_originals_32_bit_values() {
        let widened = MOVES_PX.map(|(x, y)| (f64::from(x), f64::from(y)));
        assert_eq!(widened[0], (1.224_646_852_585_167_9e-16, -2.0));
        assert_eq!(
            widened[1],
            (1.414_213_538_169_860_8, -1.414_213_538_169_860_8)
        );
        assert_eq!(widened[4], (-3.673_940_293_057_707_5e-16, 2.0));
        assert_eq!(widened[6], (-2.0, -2.449_293_705_170_335_7e-16));
    }

    #[test]
    fn zero_and_360_are_different_values_that_point_the_same_way() {
        let turned = |degrees, turn| Heading(degrees).turned(turn).degrees();
        assert_eq!(turned(315, Turn::Right), 360);
        assert_eq!(turned(360, Turn::Right), 45);
        assert_eq!(turned(45, Turn::Left), 0);
        assert_eq!(turned(0, Turn::Left), 315);
        assert_eq!(turned(360, Turn::Left), 315);
        assert_eq!(Heading(0).looks(), Heading(360).looks());
    }
}
