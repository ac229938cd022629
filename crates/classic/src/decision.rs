//! How a robot of the plain form chooses its next move (phase A of a decision).
//!
//! Seven moves are scored; the highest score wins, the lowest index among equals.
//!
//! | index | 0 | 1 | 2 | 3 | 4 | 5 | 6 |
//! |---|---|---|---|---|---|---|---|
//! | move | left slow | left fast | ahead slow | ahead fast | right slow | right fast | stop |
//!
//! The original clears the scores from index 1 on, so a robot's left-slow score begins at the
//! *carry*: the final left-slow score of the previous robot. This programming error makes the robots
//! wander; without it they circle.

use crate::heading::Turn;
use crate::robot::{Robot, Speed};
use crate::world::Grid;

const FILLED: i16 = -5;
const OFF_THE_FIELD: i16 = -10;

type Scores = [i16; 7];

/// Left, ahead, right: the index of each direction's slow score; its fast score follows.
const SLOW: [usize; 3] = [0, 2, 4];

/// Snaps the robot to its cell, chooses its turn and speed, and returns the next carry.
pub(crate) fn decide(robot: &mut Robot, grid: &Grid, carry: i16) -> i16 {
    robot.snap();
    let mut scores: Scores = [carry, 0, 0, 0, 0, 0, 0];
    look_near(robot, grid, &mut scores);
    look_far(robot, grid, &mut scores);
    penalise_circling(&mut robot.left_turns, &mut scores, 0);
    penalise_circling(&mut robot.right_turns, &mut scores, 4);
    (robot.turn, robot.speed) = chosen_move(&scores);
    scores[0]
}

fn look_near(robot: &Robot, grid: &Grid, scores: &mut Scores) {
    let cell = robot.cell();
    for (slow, step) in SLOW.into_iter().zip(robot.heading.looks()) {
        if !cell.is_inside(1) {
            scores[slow] = OFF_THE_FIELD;
        } else if grid.is_filled(cell.ahead(step, 1)) {
            scores[slow] = FILLED;
        }
    }
}

fn look_far(robot: &Robot, grid: &Grid, scores: &mut Scores) {
    let cell = robot.cell();
    for (slow, step) in SLOW.into_iter().zip(robot.heading.looks()) {
        let fast = slow + 1;
        if !cell.is_inside(2) {
            scores[fast] = OFF_THE_FIELD;
            continue;
        }
        scores[fast] = scores[slow];
        match robot.speed {
            Speed::Stopped => {}
            Speed::Slow => scores[slow] += 1,
            Speed::Fast => scores[fast] += 1,
        }
        if grid.is_filled(cell.ahead(step, 2)) {
            scores[fast] = FILLED;
        }
    }
}

/// After five turns in one direction, its scores are overwritten (which raises those of filled cells);
/// until then they increase by 1.
fn penalise_circling(turns: &mut i16, scores: &mut Scores, slow: usize) {
    if *turns > 4 {
        scores[slow] = -(*turns / 2);
        scores[slow + 1] = -(*turns / 4);
        *turns = 3;
    } else {
        scores[slow] += 1;
        scores[slow + 1] += 1;
    }
}

fn chosen_move(scores: &Scores) -> (Turn, Speed) {
    let mut best = 0;
    for index in 1..scores.len() {
        if scores[index] > scores[best] {
            best = index;
        }
    }
    match best {
        0 => (Turn::Left, Speed::Slow),
        1 => (Turn::Left, Speed::Fast),
        2 => (Turn::None, Speed::Slow),
        3 => (Turn::None, Speed::Fast),
        4 => (Turn::Right, Speed::Slow),
        5 => (Turn::Right, Speed::Fast),
        // The original tosses a coin for the side, but the coin always shows left.
        _ => (Turn::Left, Speed::Stopped),
    }
}
