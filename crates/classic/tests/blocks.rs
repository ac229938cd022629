//! Blocks of runs: the same bytes for ever, whatever other runs are requested.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use base::engine::{BlockOptions, Runner};
use classic::clock::Clock;
use classic::start::random_team;
use classic::{Configuration, Contact, Task};
use std::ops::Range;

/// The outcomes of a team with a time limit of 120 s at 56 paints per second, as columns.
fn block(robots: u32, runs: Range<u64>, seed: u64) -> Vec<Vec<f64>> {
    let clock = Clock::new(56.0, 120.0).unwrap();
    let task = Task {
        contact: Contact::Touch,
        time_limit_paints: clock.time_limit_paints,
    };
    let configuration = Configuration {
        robots,
        task,
        clock,
    };
    configuration.run_block(seed, runs, BlockOptions::ALONE)
}

/// FNV-1a over paints (all bits set if the search never ends), finds and collisions.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an infinite number of paints becomes the largest one, and all others are counts"
)]
fn hash(columns: &[Vec<f64>]) -> u64 {
    let [_, _, _, found, collisions, paints] = columns else {
        panic!("the columns have changed");
    };
    let outcomes = paints.iter().zip(found).zip(collisions);
    let words = outcomes.flat_map(|((paints, found), collisions)| [*paints, *found, *collisions]);
    let bytes = words.flat_map(|word| (word as u64).to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[test]
fn outcomes_are_the_same_bytes_for_ever() {
    // A change here changes every published result: state the reason in the commit and in the changelog.
    let golden = 9_984_463_125_805_394_549;
    assert_eq!(hash(&block(4, 0..2000, 2003)), golden);
}

#[test]
fn a_run_does_not_depend_on_the_other_runs_of_a_request() {
    let all = block(2, 0..500, 3);
    let part = block(2, 300..400, 3);
    for (column, expected) in part.iter().zip(all) {
        assert_eq!(*column, expected[300..400]);
    }
}

#[test]
fn teams_of_different_size_share_their_first_robots_starts() {
    for run in 0..50 {
        assert_eq!(random_team(3, 9, run), random_team(8, 9, run)[..3]);
    }
}

#[test]
fn more_robots_find_all_items_sooner() {
    // Means of 2,000 runs with a time limit of 120 s differ by over twenty standard errors.
    let mean = |robots| block(robots, 0..2000, 5)[0].iter().sum::<f64>() / 2000.0;
    let means: Vec<f64> = [2, 3, 5, 8].map(mean).into();
    assert!(means.is_sorted_by(|fewer, more| fewer > more), "{means:?}");
}
