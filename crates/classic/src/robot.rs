//! A robot of the plain form, and its start.

use crate::heading::{Heading, Turn};
use crate::world::{CELL_PX, Cell};

/// The surroundings of a robot at its last decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Nothing is near.
    Blue,
    /// Something on a diagonal neighbour: about to collide.
    Yellow,
    /// Something else on its own cell: collided.
    Red,
}

/// Speed in cells per decision. The original starts every robot at 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Speed {
    /// Standing.
    Stopped = 0,
    /// One cell per decision, 2 px per paint.
    Slow = 1,
    /// Two cells per decision, 4 px per paint. No robot ever reaches it from the other speeds.
    Fast = 2,
}

impl Speed {
    /// 0, 1 or 2.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8
    }
}

/// The start of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Pixels to the right.
    pub x_px: f32,
    /// Pixels down.
    pub y_px: f32,
    /// Heading.
    pub heading: Heading,
    /// Speed.
    pub speed: Speed,
}

/// A robot of the plain form, with exactly the state of the original.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Pixels to the right, a 32-bit float as in the original.
    pub x_px: f32,
    /// Pixels down.
    pub y_px: f32,
    /// Heading.
    pub heading: Heading,
    /// Speed.
    pub speed: Speed,
    /// Left turns, reduced by the circling penalty.
    pub left_turns: i16,
    /// Right turns, reduced by the circling penalty.
    pub right_turns: i16,
    /// Its surroundings at the last decision.
    pub colour: Colour,
    /// Chosen in phase A of a decision, made in phase B.
    pub(crate) turn: Turn,
}

impl Robot {
    pub(crate) fn new(start: &Start) -> Self {
        Self {
            x_px: start.x_px,
            y_px: start.y_px,
            heading: start.heading,
            speed: start.speed,
            left_turns: 0,
            right_turns: 0,
            colour: Colour::Blue,
            turn: Turn::None,
        }
    }

    /// The cell that it occupies.
    #[must_use]
    pub fn cell(&self) -> Cell {
        cell_of(self.x_px, self.y_px)
    }

    /// The grid cells that it would look at in a decision now: left, ahead and right, at distances 1
    /// and 2.
    pub fn looks(&self) -> impl Iterator<Item = Cell> + use<> {
        let (cell, looks) = (self.cell(), self.heading.looks());
        let at = move |steps| looks.map(|step| cell.ahead(step, steps)).into_iter();
        let near = at(1).filter(move |_| cell.is_inside(1));
        near.chain(at(2).filter(move |_| cell.is_inside(2)))
    }

    /// Everything visible of it, for a hash.
    pub(crate) fn words(&self) -> [u64; 3] {
        let [x, y] = [self.x_px, self.y_px].map(|px| u64::from(px.to_bits()));
        let [left, right] = [self.left_turns, self.right_turns].map(i16::cast_unsigned);
        let drawn = u64::from(self.speed.number()) << 8 | self.colour as u64;
        [
            x << 32 | y,
            u64::from(left) << 32 | u64::from(right),
            u64::from(self.heading.degrees()) << 16 | drawn,
        ]
    }

    /// Moves by one paint.
    pub(crate) fn advance(&mut self) {
        let (x_px, y_px) = self.heading.move_px();
        let speed = f32::from(self.speed.number());
        if self.speed != Speed::Stopped {
            self.x_px += x_px * speed;
            self.y_px += y_px * speed;
        }
    }

    /// Moves it exactly onto its cell.
    #[expect(clippy::cast_precision_loss, reason = "cells are small whole numbers")]
    pub(crate) fn snap(&mut self) {
        let cell = self.cell();
        self.x_px = cell.x as f32 * CELL_PX;
        self.y_px = cell.y as f32 * CELL_PX;
    }

    /// Makes the chosen turn and counts it.
    pub(crate) fn make_turn(&mut self) {
        self.heading = self.heading.turned(self.turn);
        match self.turn {
            Turn::Left => self.left_turns += 1,
            Turn::None => {}
            Turn::Right => self.right_turns += 1,
        }
    }
}

pub(crate) fn cell_of(x_px: f32, y_px: f32) -> Cell {
    Cell {
        x: nearest_cell(x_px),
        y: nearest_cell(y_px),
    }
}

/// Halves round towards plus infinity; the sum is exact in 64 bits, as it would not be in 32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "pixels are bounded: a robot that has left the grid stops at its next decision"
)]
fn nearest_cell(px: f32) -> i32 {
    (f64::from(px / CELL_PX) + 0.5).floor() as i32
}
