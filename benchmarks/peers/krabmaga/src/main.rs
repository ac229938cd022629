//! The sensing team on krABMaga: `FIELD.json neighbours` or `FIELD.json rays`; or `flock BIRDS`.
//!
//! Robots are agents on its continuous field, which tells each its neighbours within range: this is
//! the work `neighbours`. krABMaga has no sensor; in the work `rays` each robot also casts sixteen
//! rays against those neighbours, the pillars and the walls, by plain loops.

mod field;
mod flock;
mod rays;
mod robot;

use cpu_time::ProcessTime;
use field::Field;
use flock::Sky;
use krabmaga::engine::schedule::Schedule;
use krabmaga::engine::state::State;
use robot::World;

/// The least time of a piece of work, and how many there are after the first, which warms up.
const PIECE_S: f64 = 0.5;
const PIECES: usize = 5;

fn main() {
    let [first, second] = [1, 2].map(|at| std::env::args().nth(at).expect("FIELD.json WORK"));
    if first == "flock" {
        fly(second.parse().expect("a number of birds"));
    } else {
        drive(&first, &second);
    }
}

fn drive(file: &str, work: &str) {
    let text = std::fs::read_to_string(file).expect("the file is there");
    let field: Field = serde_json::from_str(&text).expect("it is a field");
    let robots = field.robots.len();
    let mut schedule = Schedule::new();
    let mut world = World::new(field, work == "rays");
    world.init(&mut schedule);
    let rates = (0..=PIECES).map(|_| updates_per_s(robots, || schedule.step(&mut world)));
    let work = match work {
        "rays" => "neighbours within 3 m from its field, 16 rays by plain loops, no noise",
        _ => "neighbours within 3 m from its field, no rays",
    };
    report(work, robots, rates.collect());
}

/// Runs of a flock, each from its start.
fn fly(birds: u32) {
    let run = || {
        let (mut schedule, mut sky) = (Schedule::new(), Sky::new(birds));
        sky.init(&mut schedule);
        let start = ProcessTime::now();
        (0..flock::STEPS).for_each(|_| schedule.step(&mut sky));
        start.elapsed().as_secs_f64()
    };
    let piece = || {
        let (mut took_s, mut updates) = (0.0, 0.0);
        while took_s < PIECE_S {
            took_s += run();
            updates += f64::from(birds) * flock::STEPS as f64;
        }
        updates / took_s
    };
    let rates = (0..=PIECES).map(|_| piece());
    report("single precision", birds as usize, rates.collect());
}

/// Prints the median of pieces of work, but for the first, which warms up.
fn report(work: &str, robots: usize, rates: Vec<f64>) {
    let mut rates = rates[1..].to_vec();
    rates.sort_by(f64::total_cmp);
    let report = serde_json::json!({
        "peer": "krABMaga",
        "version": version(),
        "work": work,
        "robots": robots,
        "updates_per_s": rates[PIECES / 2],
    });
    println!("{report}");
}

fn updates_per_s(robots: usize, mut step: impl FnMut()) -> f64 {
    let start = ProcessTime::now();
    let mut steps = 0;
    while start.elapsed().as_secs_f64() < PIECE_S {
        // The clock is a system call: it is not read for every step.
        (0..16).for_each(|_| step());
        steps += 16;
    }
    (steps * robots) as f64 / start.elapsed().as_secs_f64()
}

/// Of krABMaga, as locked.
fn version() -> &'static str {
    let lock = include_str!("../Cargo.lock");
    let entry = lock.split("[[package]]\nname = \"krabmaga\"\n").nth(1);
    entry
        .and_then(|entry| entry.split('"').nth(1))
        .unwrap_or("?")
}
