//! How fast the metric simulator is, beside a bare program of the same work, in one run.
//!
//! `make bench`, or `cargo run --release -p agent-economy-benchmarks -- [team | search | flock | minds | world]`.
//! `-- field` prints the team's field in JSON instead.
//! Times are those for which threads had a processor; each figure is the median of many short
//! pieces of work, those that are compared taken in turns. docs/speed.md says what came of it.

#![expect(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark may fail, and prints"
)]
mod clock;
mod field;
mod flock;
mod minds;
mod peers;
mod scenarios;
mod search;
mod speed_of_light;
mod team;
mod threads;
mod world;

fn main() {
    let rayon = rayon::ThreadPoolBuilder::new().num_threads(1);
    rayon.build_global().expect("no pool has been made yet");
    let only = std::env::args().nth(1);
    if only.as_deref() == Some("field") {
        return peers::report();
    }
    let is_wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    let reports = [
        ("team", team::report as fn()),
        ("search", search::report),
        ("flock", flock::report),
        ("minds", minds::report),
        ("world", world::report),
    ];
    for (name, report) in reports.iter().filter(|(name, _)| is_wanted(name)) {
        println!("\n{name}\n");
        report();
    }
}
