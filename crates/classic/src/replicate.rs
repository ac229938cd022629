//! Many runs at once, with random starts or with every possible start.

use crate::fast::FastSearch;
use crate::search::{Outcome, Task};
use crate::start::{FIRST_CELL, START_CELLS, random_cell};
use crate::world::Cell;
use rayon::prelude::*;
use std::ops::Range;

/// Runs per task of the thread pool: enough to hide the cost of a task, few enough to balance. It is both
/// minimum and maximum: by default, rayon splits the work of two threads into quarters, and one thread
/// waits for the other's last quarter.
const RUNS_PER_TASK: usize = 64;

/// The outcomes of `runs` (run numbers, not a count) of a team with random starts, in their order.
///
/// It uses the threads of the current rayon pool; the outcomes are the same for any number of them.
#[must_use]
pub fn replicate(robots: u32, runs: Range<u64>, seed: u64, task: Task) -> Vec<Outcome> {
    in_parallel(runs, task, |search, run| run_of(search, robots, seed, run))
}

/// One run of a team with random starts.
pub(crate) fn run_of(search: &mut FastSearch, robots: u32, seed: u64, run: u64) -> Outcome {
    search.run((0..robots).map(|index| random_cell(seed, run, index)))
}

/// Number of possible starts of a team: 289 for each robot.
#[must_use]
pub fn number_of_starts(robots: u32) -> Option<u64> {
    (u64::from(START_CELLS) * u64::from(START_CELLS)).checked_pow(robots)
}

/// The cells of a start, by its number. The column of the first robot varies slowest, the row of the last
/// robot fastest.
#[must_use]
pub fn start_cells(robots: u32, start: u64) -> Vec<Cell> {
    let mut rest = start;
    let mut coordinate = || {
        let offset = rest % u64::from(START_CELLS);
        rest /= u64::from(START_CELLS);
        i32::from(FIRST_CELL) + i32::from(offset.to_le_bytes()[0])
    };
    let mut cells: Vec<Cell> = (0..robots)
        .map(|_| {
            let y = coordinate();
            Cell { x: coordinate(), y }
        })
        .collect();
    cells.reverse();
    cells
}

/// The outcomes of the starts with these numbers, in their order.
#[must_use]
pub fn exhaust(robots: u32, starts: Range<u64>, task: Task) -> Vec<Outcome> {
    let run =
        |search: &mut FastSearch, start: u64| search.run(start_cells(robots, start).into_iter());
    in_parallel(starts, task, run)
}

fn in_parallel(
    numbers: Range<u64>,
    task: Task,
    run: impl Fn(&mut FastSearch, u64) -> Outcome + Sync,
) -> Vec<Outcome> {
    let numbers: Vec<u64> = numbers.collect();
    numbers
        .par_iter()
        .with_min_len(RUNS_PER_TASK)
        .with_max_len(RUNS_PER_TASK)
        .map_init(
            || FastSearch::new(task),
            |search, number| run(search, *number),
        )
        .collect()
}
