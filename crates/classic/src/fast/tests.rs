use super::*;
use crate::robot::Robot;
use crate::simulation::Simulation;
use crate::start::{random_cell, team_on};

/// The state in a word, in terms of the plain form; 0 and 360 degrees are one octant.
fn described(word: Word) -> (Cell, usize, usize, u32, u32) {
    let field = |shift: u32| (word >> shift & 0xf) - 3;
    (
        word::cell(word),
        word::motion(word) / 2,
        word::speed(word),
        field(16),
        field(20),
    )
}

fn plain(robot: &Robot) -> (Cell, usize, usize, u32, u32) {
    let turns = |turns: i16| u32::try_from(turns).unwrap();
    (
        robot.cell(),
        robot.heading.octant(),
        usize::from(robot.speed.number()),
        turns(robot.left_turns),
        turns(robot.right_turns),
    )
}

#[test]
fn every_robot_is_in_the_same_state_after_every_decision_as_in_the_plain_form() {
    let task = Task {
        contact: Contact::Neighbour,
        time_limit_paints: 0,
    };
    let mut compared = 0;
    let sizes = [1, 2, 3, 4, 6, 9, 16, 40].into_iter().cycle();
    for (robots, run) in sizes.zip(0..600) {
        let cells: Vec<Cell> = (0..robots)
            .map(|index| random_cell(11, run, index))
            .collect();
        let mut fast = FastSearch::new(task);
        fast.place(cells.iter().copied());
        let mut tally = fast.tally_of_start();
        let mut simulation = Simulation::new(&team_on(&cells));
        for decision in 1..=500 {
            fast.decide::<false>(&mut tally);
            while !simulation.step() {}
            let expected: Vec<_> = simulation.robots().iter().map(plain).collect();
            let given: Vec<_> = fast.robots.iter().map(|word| described(*word)).collect();
            assert_eq!(given, expected, "run {run}, decision {decision}");
            assert_eq!(
                fast.carry,
                i32::from(simulation.carry),
                "run {run}, decision {decision}"
            );
            compared += robots;
        }
    }
    assert!(compared > 3_000_000, "{compared} robot-decisions");
}
