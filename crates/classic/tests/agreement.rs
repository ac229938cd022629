//! The fast form gives the outcomes of the plain form, for every contact, team size and cap.

use classic::start::{MAX_ROBOTS, random_cell, random_team};
use classic::{Contact, FastSearch, Outcome, Task, search};

const SEED: u64 = 2003;

fn both(robots: u32, run: u64, task: Task) -> (Outcome, Outcome) {
    let cells = (0..robots).map(|index| random_cell(SEED, run, index));
    let fast = FastSearch::new(task).run(cells);
    (search(&random_team(robots, SEED, run), task), fast)
}

#[test]
fn fast_and_plain_agree_on_millions_of_random_robot_decisions() {
    let mut robot_decisions = 0;
    for (name, contact) in Contact::NAMES {
        for robots in [1, 2, 3, 4, 5, 8, 20] {
            for run in 0..300 {
                let task = Task {
                    contact,
                    cap_paints: 6720,
                };
                let (plain, fast) = both(robots, run, task);
                assert_eq!(plain, fast, "{name}, {robots} robots, run {run}");
                robot_decisions += u64::from(robots) * plain.paints.unwrap_or(6720) / 11;
            }
        }
    }
    assert!(robot_decisions > 2_000_000, "{robot_decisions}");
}

#[test]
fn fast_and_plain_agree_on_the_largest_team() {
    for (name, contact) in Contact::NAMES {
        for run in 0..10 {
            let task = Task {
                contact,
                cap_paints: 6720,
            };
            let (plain, fast) = both(MAX_ROBOTS, run, task);
            assert_eq!(plain, fast, "{name}, run {run}");
        }
    }
}

#[test]
fn fast_and_plain_agree_on_where_a_cap_cuts_the_counts() {
    for (name, contact) in Contact::NAMES {
        for run in 0..400 {
            let task = Task {
                contact,
                cap_paints: run * 7 % 1000,
            };
            let (plain, fast) = both(3, run, task);
            assert_eq!(plain, fast, "{name}, run {run}, cap {}", task.cap_paints);
        }
    }
}
