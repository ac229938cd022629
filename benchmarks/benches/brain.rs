//! Time of one step of one brain: 16 rays, the three behaviours of the default brain.
//!
//! `cargo bench -p agent-economy-benchmarks --bench brain`. In each pass 1000 brains of one kind take
//! one step with the same percept, like a simulator that fills one percept after the other.

use brain::{Body, Brain, BrainSpec, Command, Percept, RangeRing, Reading, Scan};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;

const ROBOTS: u64 = 1000;

fn body() -> Body {
    let bearing =
        |ray: i32| f64::from(if ray > 8 { ray - 16 } else { ray }) * 22.5_f64.to_radians();
    Body {
        radius_m: 0.25,
        max_speed_m_s: 1.0,
        max_acceleration_m_s2: 1.0,
        max_turn_rate_rad_s: 1.5,
        period_s: 0.1,
        rings: vec![RangeRing {
            bearings_rad: (0..16).map(bearing).collect(),
            range_m: 3.0,
            period_s: 0.1,
            latency_s: 0.0,
        }],
        ..Body::default()
    }
}

fn percept(ranges_m: Vec<f64>) -> Percept {
    let scan = Scan {
        age_s: Some(0.0),
        ranges_m,
    };
    Percept {
        random_words: [1 << 31; 4],
        touch: Some(Reading {
            value: false,
            age_s: 0.0,
        }),
        scans: vec![scan],
        ..Percept::default()
    }
}

fn step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(ROBOTS));
    let open = percept(vec![f64::INFINITY; 16]);
    // Every ray has an echo, and the way ahead is free for a while.
    let cluttered = percept(
        (0_u32..16)
            .map(|ray| 1.0 + 0.1 * f64::from(ray % 7))
            .collect(),
    );
    let walled = percept(vec![0.6; 16]);
    for (name, percept) in [
        ("open", open),
        ("cluttered", cluttered),
        ("walled in", walled),
    ] {
        let fresh = Brain::new(Arc::new(BrainSpec::default()), Arc::new(body()));
        let mut brains = vec![fresh; 1000];
        let mut command = Command::default();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for brain in &mut brains {
                    brain.step_into(black_box(&percept), &mut command);
                    black_box(&command);
                }
            });
        });
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
