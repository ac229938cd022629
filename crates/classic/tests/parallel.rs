//! Many runs at once: the same for any number of threads, and every start there is.

#![expect(clippy::expect_used, reason = "a test may panic")]

use classic::replicate::{exhaust, number_of_starts, start_cells};
use classic::start::{random_team, team_on};
use classic::{Contact, Outcome, Task, replicate, search};

const TASK: Task = Task {
    contact: Contact::Touch,
    time_limit_paints: 6720,
};

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().expect("a pool").install(work)
}

/// FNV-1a over the outcomes.
fn hash(outcomes: &[Outcome]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for outcome in outcomes {
        let words = [
            outcome.paints.map_or(u64::MAX, |paints| paints),
            outcome.found.into(),
            outcome.collisions,
        ];
        for byte in words.into_iter().flat_map(u64::to_le_bytes) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    hash
}

#[test]
fn outcomes_do_not_depend_on_the_number_of_threads() {
    let one = on_threads(1, || replicate(3, 0..3000, 7, TASK));
    for threads in [2, 3, 8] {
        assert_eq!(one, on_threads(threads, || replicate(3, 0..3000, 7, TASK)));
    }
}

#[test]
fn outcomes_are_the_same_bytes_for_ever() {
    // A change here changes every published result: state the reason in the commit and in the changelog.
    let golden = 9_984_463_125_805_394_549;
    assert_eq!(hash(&replicate(4, 0..2000, 2003, TASK)), golden);
}

#[test]
fn a_run_does_not_depend_on_the_other_runs_of_a_request() {
    let all = replicate(2, 0..500, 3, TASK);
    assert_eq!(all[300..400], replicate(2, 300..400, 3, TASK));
}

#[test]
fn teams_of_different_size_share_their_first_robots_starts() {
    for run in 0..50 {
        assert_eq!(random_team(3, 9, run), random_team(8, 9, run)[..3]);
    }
}

#[test]
fn every_start_of_one_robot_ends_as_in_the_plain_form() {
    for (name, contact) in Contact::NAMES {
        let task = Task {
            contact,
            time_limit_paints: 0,
        };
        let outcomes = exhaust(1, 0..289, task);
        for (start, outcome) in (0..).zip(&outcomes) {
            let expected = search(&team_on(&start_cells(1, start)), task);
            assert_eq!(expected, *outcome, "{name}, start {start}");
        }
    }
}

#[test]
fn starts_are_numbered_by_the_first_robots_column_first() {
    assert_eq!(number_of_starts(1), Some(289));
    assert_eq!(number_of_starts(2), Some(83_521));
    let cells = start_cells(2, 17 * 17 + 2 * 17 + 3);
    let coordinates: Vec<_> = cells.iter().map(|cell| (cell.x, cell.y)).collect();
    assert_eq!(coordinates, [(4, 5), (6, 7)]);
}

#[test]
fn more_robots_find_all_items_sooner() {
    // Means of 2,000 runs with a time limit of 6,720 paints differ by over twenty standard errors.
    let mean = |robots: u32| {
        let outcomes = replicate(robots, 0..2000, 5, TASK);
        let paints = |outcome: &Outcome| outcome.paints.unwrap_or(6720).min(6720);
        outcomes.iter().map(paints).sum::<u64>() / 2000
    };
    let means: Vec<u64> = [2, 3, 5, 8].map(mean).into();
    assert!(means.is_sorted_by(|fewer, more| fewer > more), "{means:?}");
}
