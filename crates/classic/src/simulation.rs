//! The plain form: the 2003 program, rule by rule. The fast form is tested against it.

use crate::clock;
use crate::decision::decide;
use crate::heading::Heading;
use crate::robot::{Colour, Robot, Speed, Start};
use crate::world::Grid;

const DIAGONALS: [(i32, i32); 4] = [(1, 1), (1, -1), (-1, 1), (-1, -1)];

/// A run of the plain form, with the complete state of the original program.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(crate) robots: Vec<Robot>,
    /// What the robots see at the next decision: the positions at the last decision.
    pub(crate) grid: Grid,
    /// The left-slow score of the robot that decided last; see [`crate::decision`].
    pub(crate) carry: i16,
    pub(crate) paint: u64,
}

/// The state that determines the future of a run, at a decision. Every robot is then exactly on its
/// cell, so pixels are left out. A state that recurs once recurs forever.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct State {
    carry: i16,
    robots: Vec<(i32, i32, Heading, Speed, i16, i16)>,
}

impl Simulation {
    /// A run before its first paint.
    #[must_use]
    pub fn new(starts: &[Start]) -> Self {
        let robots: Vec<Robot> = starts.iter().map(Robot::new).collect();
        let mut grid = Grid::new();
        grid.refresh(robots.iter().map(Robot::cell));
        Self {
            robots,
            grid,
            carry: 0,
            paint: 0,
        }
    }

    /// Number of paints so far.
    #[must_use]
    pub fn paint(&self) -> u64 {
        self.paint
    }

    /// Number of paints until the next decision.
    #[must_use]
    pub fn decides_in(&self) -> u64 {
        clock::decides_in(self.paint)
    }

    /// The left-slow score that the last robot to decide passes to the next one.
    #[must_use]
    pub fn carry(&self) -> i16 {
        self.carry
    }

    /// The robots, in the order in which they decide.
    #[must_use]
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// Advances by one paint: every robot moves, and on some paints the team then decides. Returns whether
    /// it decided.
    pub fn step(&mut self) -> bool {
        self.paint += 1;
        self.robots.iter_mut().for_each(Robot::advance);
        let is_decision = clock::is_decision(self.paint);
        if is_decision {
            self.choose();
            self.turn();
            self.colour();
        }
        is_decision
    }

    /// Phase A. All robots look at the same grid, that of the last decision.
    fn choose(&mut self) {
        for robot in &mut self.robots {
            self.carry = decide(robot, &self.grid, self.carry);
        }
    }

    /// Phase B.
    fn turn(&mut self) {
        self.robots.iter_mut().for_each(Robot::make_turn);
        self.grid.refresh(self.robots.iter().map(Robot::cell));
    }

    /// Phase C. Orthogonal neighbours and cells outside the grid do not count.
    fn colour(&mut self) {
        for robot in &mut self.robots {
            let cell = robot.cell();
            let is_near = |step: &(i32, i32)| self.grid.is_filled(cell.ahead(*step, 1));
            robot.colour = match self.grid.count(cell) {
                Some(count) if count > 1 => Colour::Red,
                Some(_) if DIAGONALS.iter().any(is_near) => Colour::Yellow,
                _ => Colour::Blue,
            };
        }
    }

    pub(crate) fn state(&self) -> State {
        let state = |robot: &Robot| {
            let cell = robot.cell();
            let turns = (robot.left_turns, robot.right_turns);
            (cell.x, cell.y, robot.heading, robot.speed, turns.0, turns.1)
        };
        State {
            carry: self.carry,
            robots: self.robots.iter().map(state).collect(),
        }
    }
}

#[cfg(test)]
mod tests;
