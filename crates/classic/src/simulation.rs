//! The plain form: the 2003 program, rule by rule. The fast form is tested against it.

use crate::clock;
use crate::decision::decide;
use crate::heading::Heading;
use crate::robot::{Colour, Robot, Speed, Start};
use crate::world::Grid;

const DIAGONALS: [(i32, i32); 4] = [(1, 1), (1, -1), (-1, 1), (-1, -1)];

/// A run of the plain form: everything the original program held, paint by paint.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(crate) robots: Vec<Robot>,
    /// What the robots see at the next decision: where everyone stood at the last.
    pub(crate) grid: Grid,
    /// The left-slow score of the robot that decided last; see [`crate::decision`].
    pub(crate) carry: i16,
    pub(crate) paint: u64,
}

/// What decides the whole future between two decisions. Pixels are left out: at a decision every
/// robot stands exactly on its cell. So a state that comes again will come again for ever.
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

    /// Paints so far.
    #[must_use]
    pub fn paint(&self) -> u64 {
        self.paint
    }

    /// Paints until the team decides next.
    #[must_use]
    pub fn decides_in(&self) -> u64 {
        clock::decides_in(self.paint)
    }

    /// The left-slow score that the robot which decided last has left to the next.
    #[must_use]
    pub fn carry(&self) -> i16 {
        self.carry
    }

    /// The robots, in the order in which they decide.
    #[must_use]
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// One paint: every robot moves; on some paints the team then decides. Says whether it did.
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

    /// Phase A. All look at the same grid, the one of the last decision.
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

    /// Phase C. Orthogonal neighbours do not count; outside the grid nothing does.
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
