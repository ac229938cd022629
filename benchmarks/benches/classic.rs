//! Robot-decisions per second of the fast form, beside a program that does much less.
//!
//! `cargo bench -p agent-economy-benchmarks --bench classic`. Criterion's "elem/s" are robot-decisions per second:
//! starts, contact and proofs of "never" are included in the time and not in the count.
//!
//! *Speed of light*: robots that wander on the same grid, look at the same three cells and turn
//! at random, with no scores, no carry, no contact, no end.

#![expect(clippy::unwrap_used, reason = "a benchmark may panic")]

use classic::clock::{DECISION_PERIOD, FIRST_DECISION};
use classic::start::{random_cell, random_team};
use classic::world::cells;
use classic::{Contact, FastSearch, Outcome, Task, search};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rayon::prelude::*;
use std::hint::black_box;

const RUNS: u64 = 20_000;

/// Runs per task of the thread pool: enough to hide the cost of a task, few enough to balance.
const RUNS_PER_TASK: usize = 64;

/// The outcomes of runs 0 to [`RUNS`], on the threads of the current pool.
fn outcomes(robots: u32, task: Task) -> Vec<Outcome> {
    let run = |search: &mut FastSearch, run: u64| {
        search.run((0..robots).map(|index| random_cell(1, run, index)))
    };
    let runs: Vec<u64> = (0..RUNS).collect();
    runs.into_par_iter()
        .with_min_len(RUNS_PER_TASK)
        .with_max_len(RUNS_PER_TASK)
        .map_init(|| FastSearch::new(task), run)
        .collect()
}

/// Robot-decisions until completion; proofs of "never" are left out, so the rate is understated.
fn robot_decisions(robots: u32, outcomes: &[Outcome]) -> u64 {
    let paints = outcomes.iter().filter_map(|outcome| outcome.paints);
    let decisions = |paints: u64| match paints.checked_sub(FIRST_DECISION) {
        Some(rest) => 1 + rest / DECISION_PERIOD,
        None => 0,
    };
    u64::from(robots) * paints.map(decisions).sum::<u64>()
}

fn fast_form(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("fast form");
    for (robots, contact, threads) in [
        (4, Contact::Neighbour, 1),
        (4, Contact::Neighbour, 2),
        (4, Contact::Touch, 1),
        (1, Contact::Neighbour, 1),
        (8, Contact::Neighbour, 1),
    ] {
        let task = Task {
            contact,
            time_limit_paints: 6720,
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        group.throughput(Throughput::Elements(robot_decisions(
            robots,
            &outcomes(robots, task),
        )));
        let name = format!("{robots} robots, {contact:?}, {threads} thread(s)");
        group.bench_function(name, |bencher| {
            bencher.iter(|| pool.install(|| outcomes(black_box(robots), task)));
        });
    }
}

fn plain_form(criterion: &mut Criterion) {
    let task = Task {
        contact: Contact::Neighbour,
        time_limit_paints: 6720,
    };
    let plain = |run| search(&random_team(4, 1, run), task);
    let all = || (0..200).map(plain);
    let mut group = criterion.benchmark_group("plain form");
    group.throughput(Throughput::Elements(robot_decisions(
        4,
        &all().collect::<Vec<_>>(),
    )));
    group.bench_function("4 robots, neighbour, 1 thread", |bencher| {
        bencher.iter(|| all().map(|outcome| outcome.collisions).sum::<u64>());
    });
}

/// Four random wanderers with three-cell sensing: `(cell, octant)` each, one grid.
fn wander(decisions: u32) -> [(usize, usize); 4] {
    let steps: [isize; 8] = [-1, 24, 25, 26, 1, -24, -25, -26];
    let mut grid: Vec<u8> = cells().map(|cell| u8::from(cell.is_static())).collect();
    let mut robots: [(usize, usize); 4] = [(260, 0), (265, 1), (390, 2), (395, 3)];
    let mut state = 1_u64;
    for _ in 0..decisions {
        for (cell, octant) in &mut robots {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let free =
                |turn: usize| grid[cell.wrapping_add_signed(steps[(*octant + turn) % 8])] == 0;
            let seen = usize::from(free(7)) | usize::from(free(0)) << 1 | usize::from(free(1)) << 2;
            let turn = [4, 7, 0, 7, 1, 1, 0, 0][seen] + usize::from((state >> 60) == 0);
            *octant = (*octant + turn) % 8;
            let ahead = cell.wrapping_add_signed(steps[*octant]);
            grid[*cell] = 0;
            *cell = if grid[ahead] == 0 { ahead } else { *cell };
            grid[*cell] = 1;
        }
    }
    robots
}

fn speed_of_light(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("speed of light");
    group.throughput(Throughput::Elements(4_000_000));
    group.bench_function("4 random wanderers, 1 thread", |bencher| {
        bencher.iter(|| wander(black_box(1_000_000)));
    });
}

criterion_group!(benches, fast_form, plain_form, speed_of_light);
criterion_main!(benches);
