//! Speed of the metric simulator, compared with a minimal program that does the same work.
//!
//! `make bench`, or `cargo run --release -p agent-economy-benchmarks -- [team | search | flock | brains | world]`.
//! `-- field` prints the field of the team as JSON instead.
//! Times are processor times; each figure is the median of many short samples, and the programs that are
//! compared alternate. The results are in docs/speed.md.

#![expect(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark may fail, and prints"
)]
mod brains;
mod clock;
mod field;
mod flock;
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
    let is_selected = |name: &str| only.as_deref().is_none_or(|only| only == name);
    let reports = [
        ("team", team::report as fn()),
        ("search", search::report),
        ("flock", flock::report),
        ("brains", brains::report),
        ("world", world::report),
    ];
    for (name, report) in reports.iter().filter(|(name, _)| is_selected(name)) {
        println!("\n{name}\n");
        report();
    }
}
