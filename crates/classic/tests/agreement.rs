//! The fast form gives the outcomes of the plain form, for every contact, team size and cap.

use classic::start::{random_cell, random_team};
use classic::{Contact, FastSearch, Outcome, Rules, search};

const SEED: u64 = 2003;

fn both(robots: u32, run: u64, rules: Rules) -> (Outcome, Outcome) {
    let cells = (0..robots).map(|index| random_cell(SEED, run, index));
    let fast = FastSearch::new(rules).run(cells);
    (search(&random_team(robots, SEED, run), rules), fast)
}

#[test]
fn fast_and_plain_agree_on_millions_of_random_robot_decisions() {
    let mut robot_decisions = 0;
    for (name, contact) in Contact::NAMES {
        for robots in [1, 2, 3, 4, 5, 8, 20] {
            for run in 0..300 {
                let rules = Rules {
                    contact,
                    cap_paints: 6720,
                };
                let (plain, fast) = both(robots, run, rules);
                assert_eq!(plain, fast, "{name}, {robots} robots, run {run}");
                robot_decisions += u64::from(robots) * plain.paints.unwrap_or(6720) / 11;
            }
        }
    }
    assert!(robot_decisions > 2_000_000, "{robot_decisions}");
}

#[test]
fn fast_and_plain_agree_on_where_a_cap_cuts_the_counts() {
    for (name, contact) in Contact::NAMES {
        for run in 0..400 {
            let rules = Rules {
                contact,
                cap_paints: run * 7 % 1000,
            };
            let (plain, fast) = both(3, run, rules);
            assert_eq!(plain, fast, "{name}, run {run}, cap {}", rules.cap_paints);
        }
    }
}
