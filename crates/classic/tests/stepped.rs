//! A run stepped by its caller equals the run of a study, and a run with changes can be replayed.

use base::engine::{BlockOptions, Runner};
use classic::clock::Clock;
use classic::{Configuration, Contact, Run, Task};

const SEED: u64 = 2003;

fn configuration(robots: u32, contact: Contact, time_limit_paints: u32) -> Configuration {
    Configuration {
        robots,
        task: Task {
            contact,
            time_limit_paints: time_limit_paints.into(),
        },
        clock: Clock {
            paints_per_s: 50.0,
            time_limit_s: f64::from(time_limit_paints) / 50.0,
            time_limit_paints: time_limit_paints.into(),
        },
    }
}

fn stepped(run: &mut Run, paints: u64) {
    for _ in 0..paints {
        run.step();
    }
}

fn finished(mut run: Run) -> Run {
    while !run.search().is_over() {
        run.step();
    }
    run
}

#[test]
fn a_finished_run_gives_the_measures_of_a_study() {
    for (robots, runs) in [(1, 60), (2, 60), (3, 40), (8, 20), (250, 1)] {
        for (_, contact) in Contact::NAMES {
            for time_limit_paints in [0, 12, 700, 6720] {
                let configuration = configuration(robots, contact, time_limit_paints);
                let columns = configuration.run_block(SEED, 0..runs, BlockOptions::ALONE);
                for (run, number) in (0..runs).enumerate() {
                    let values = finished(Run::new(configuration, SEED, number)).values();
                    let expected: Vec<f64> = columns.iter().map(|column| column[run]).collect();
                    assert_eq!(values, expected, "{configuration:?}, run {number}");
                }
            }
        }
    }
}

#[test]
fn a_run_that_is_over_stays_as_it_is() {
    let mut run = finished(Run::new(configuration(4, Contact::Touch, 6720), SEED, 1));
    let (hash, values) = (run.search().hash(), run.values());
    stepped(&mut run, 100);
    assert_eq!((run.search().hash(), run.values()), (hash, values));
}

#[test]
fn a_change_before_the_first_paint_gives_the_run_of_the_changed_team() {
    for (from, to) in [(1, 250), (6, 1), (4, 7), (7, 4)] {
        let [from, to] = [from, to].map(|robots| configuration(robots, Contact::Ahead, 6720));
        let mut changed = Run::new(from, SEED, 5);
        changed.change(to);
        let mut begun = Run::new(to, SEED, 5);
        for _ in 0..100 {
            assert_eq!(changed.search().hash(), begun.search().hash());
            stepped(&mut changed, 7);
            stepped(&mut begun, 7);
        }
    }
}

#[test]
fn changes_at_the_same_paints_give_the_same_run() {
    let changed = || {
        let mut run = Run::new(configuration(3, Contact::Touch, 6720), SEED, 9);
        let mut hashes = Vec::new();
        let changes = [
            (5, 40, Contact::Touch, 6720),
            (18, 2, Contact::Within2, 6720),
            (12, 5, Contact::Ahead, 300),
            (200, 5, Contact::Neighbour, 9000),
        ];
        for (paints, robots, contact, time_limit_paints) in changes {
            stepped(&mut run, paints);
            run.change(configuration(robots, contact, time_limit_paints));
            hashes.push(run.search().hash());
        }
        hashes.push(finished(run).search().hash());
        hashes
    };
    assert_eq!(changed(), changed());
}

#[test]
fn after_a_change_remaining_robots_continue_and_new_ones_begin_at_their_starts() {
    let mut run = Run::new(configuration(3, Contact::Touch, 6720), SEED, 2);
    stepped(&mut run, 30);
    let before = run.search().simulation().robots().to_vec();
    run.change(configuration(5, Contact::Touch, 6720));
    let after = run.search().simulation().robots().to_vec();
    assert_eq!(after[..3], before[..]);
    let begun = Run::new(configuration(5, Contact::Touch, 6720), SEED, 2);
    assert_eq!(after[3..], begun.search().simulation().robots()[3..]);
    run.change(configuration(2, Contact::Touch, 6720));
    assert_eq!(run.search().simulation().robots(), &before[..2]);
}

#[test]
fn finds_of_removed_robots_remain() {
    let mut run = finished(Run::new(configuration(250, Contact::Touch, 6720), SEED, 0));
    run.change(configuration(1, Contact::Touch, 6720));
    assert!(run.search().is_over());
    assert_eq!(run.values()[3].to_bits(), 4.0_f64.to_bits());
}

#[test]
fn a_run_that_cannot_complete_is_over_early_and_a_changed_team_can_complete_it() {
    let runs =
        (0..200).map(|number| Run::new(configuration(1, Contact::Touch, 900_000), SEED, number));
    let stuck = runs.map(finished).find(|run| run.values()[5].is_infinite());
    let mut run = stuck.unwrap();
    assert!(run.paint() < 100_000);
    run.change(configuration(9, Contact::Touch, 900_000));
    assert!(!run.search().is_over());
    assert!(finished(run).values()[5].is_finite());
}

#[test]
fn a_longer_cap_lets_a_capped_run_go_on_as_if_it_had_been_so_from_the_start() {
    let mut run = finished(Run::new(configuration(3, Contact::Ahead, 100), SEED, 3));
    assert_eq!(run.paint(), 100);
    run.change(configuration(3, Contact::Ahead, 6720));
    let begun = finished(Run::new(configuration(3, Contact::Ahead, 6720), SEED, 3));
    assert_eq!(finished(run).search().hash(), begun.search().hash());
}

#[test]
fn the_hash_of_a_state_is_the_same_on_every_machine() {
    let mut run = Run::new(configuration(8, Contact::Touch, 6720), SEED, 0);
    stepped(&mut run, 100);
    assert_eq!(run.search().hash(), 0x9351_9214_100E_2DA1);
}
