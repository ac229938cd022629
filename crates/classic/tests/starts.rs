//! Every possible start of one and of two robots: the fast form ends as the plain form, and the number of
//! searches that never end is the published one (`docs/replication.md`).

use classic::start::{FIRST_CELL, START_CELLS, team_on};
use classic::world::Cell;
use classic::{Contact, FastSearch, Outcome, Task, search};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The cells on which a robot may start.
fn start_cells() -> impl Iterator<Item = Cell> {
    let range = i32::from(FIRST_CELL)..i32::from(FIRST_CELL + START_CELLS);
    range
        .clone()
        .flat_map(move |x| range.clone().map(move |y| Cell { x, y }))
}

/// Every start of a team of one or two robots.
fn every_start(robots: u32) -> Vec<Vec<Cell>> {
    let one = start_cells().map(|cell| vec![cell]);
    if robots == 1 {
        return one.collect();
    }
    one.flat_map(|first| start_cells().map(move |second| vec![first[0], second]))
        .collect()
}

/// The outcomes of these starts, in their order.
fn outcomes(starts: &[Vec<Cell>], task: Task) -> Vec<Outcome> {
    let mut search = FastSearch::new(task);
    let run = |cells: &Vec<Cell>| search.run(cells.iter().copied());
    starts.iter().map(run).collect()
}

fn task(contact: Contact) -> Task {
    Task {
        contact,
        time_limit_paints: 0,
    }
}

#[test]
fn every_start_of_one_robot_ends_as_in_the_plain_form() {
    let starts = every_start(1);
    for (name, contact) in Contact::NAMES {
        let given = outcomes(&starts, task(contact));
        for (cells, outcome) in starts.iter().zip(given) {
            let expected = search(&team_on(cells), task(contact));
            assert_eq!(expected, outcome, "{name}, start {cells:?}");
        }
    }
}

/// `RENEW_REPLICATION=1` writes the file from which `scripts/replication.py` makes the table.
#[test]
fn the_published_numbers_of_searches_that_never_end_are_those_of_every_start() {
    let teams = [1, 2].map(|robots| (robots, every_start(robots)));
    let mut made = "contact,robots,starts,never\n".to_owned();
    for (name, contact) in Contact::NAMES {
        for (robots, starts) in &teams {
            let outcomes = outcomes(starts, task(contact));
            let never = outcomes.iter().filter(|outcome| outcome.paints.is_none());
            writeln!(made, "{name},{robots},{},{}", starts.len(), never.count()).unwrap();
        }
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/replication/starts.csv");
    if std::env::var_os("RENEW_REPLICATION").is_some() {
        fs::write(&file, &made).unwrap();
    }
    let published = fs::read_to_string(&file).unwrap();
    assert_eq!(published, made, "run `make replication`");
}
