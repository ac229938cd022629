//! The fast form gives the outcomes of the plain form, for every contact, team size and time limit.

use classic::start::{MAX_ROBOTS, random_cell, random_team};
use classic::{Contact, FastSearch, Outcome, Task, search};

const SEED: u64 = 2003;

/// The outcome of a run, which both forms must give.
fn agreed(
    robots: u32,
    run: u64,
    (name, contact): (&str, Contact),
    time_limit_paints: u64,
) -> Outcome {
    let task = Task {
        contact,
        time_limit_paints,
    };
    let cells = (0..robots).map(|index| random_cell(SEED, run, index));
    let fast = FastSearch::new(task).run(cells);
    let plain = search(&random_team(robots, SEED, run), task);
    assert_eq!(
        plain, fast,
        "{name}, {robots} robots, run {run}, time limit {time_limit_paints}"
    );
    plain
}

#[test]
fn fast_and_plain_agree_on_millions_of_random_robot_decisions() {
    let mut robot_decisions = 0;
    for contact in Contact::NAMES {
        for robots in [1, 2, 3, 4, 5, 8, 20] {
            for run in 0..300 {
                let outcome = agreed(robots, run, contact, 6720);
                robot_decisions += u64::from(robots) * outcome.paints.unwrap_or(6720) / 11;
            }
        }
    }
    assert!(robot_decisions > 2_000_000, "{robot_decisions}");
}

#[test]
fn fast_and_plain_agree_on_the_largest_team() {
    for contact in Contact::NAMES {
        for run in 0..10 {
            agreed(MAX_ROBOTS, run, contact, 6720);
        }
    }
}

#[test]
fn fast_and_plain_agree_on_where_a_time_limit_cuts_the_counts() {
    for contact in Contact::NAMES {
        for run in 0..400 {
            agreed(3, run, contact, run * 7 % 1000);
        }
    }
}
