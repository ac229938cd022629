//! Scratch speed test.
use base::geometry::{Disc, Point, Polygon};
use sim::engine::Simulation;
use sim::scenario::{Scenario, ScenarioSpec};
use sim::world::obstacles::Solid;
use std::sync::Arc;
use std::time::Instant;

fn cpu_s() -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse::<f64>().unwrap() / 1e9
}

fn main() {
    let robots: u32 = std::env::args()
        .nth(1)
        .and_then(|a| a.parse().ok())
        .unwrap_or(100);
    let noise: f64 = std::env::args()
        .nth(2)
        .and_then(|a| a.parse().ok())
        .unwrap_or(0.0);
    let side = 20.0 * (f64::from(robots) / 100.0).sqrt();
    let spec = serde_json::json!({
        "clock": {"cap_s": 1e6},
        "world": {"size_m": [side, side]},
        "robots": {"rover": {"count": robots, "radius_m": 0.2,
            "drive": {"max_speed_m_s": 0.5, "max_acceleration_m_s2": 1.0, "max_turn_rate_deg_s": 90.0},
            "battery": {"idle_w": 10.0, "move_w": 5.0, "move_j_per_m": 10.0},
            "sensors": {"sonar": {"kind": "range", "rays": 16, "range_m": 3.0, "noise_m": noise}}}}
    });
    let spec: ScenarioSpec = serde_json::from_value(spec).unwrap();
    let mut solids = Vec::new();
    let tiles = (side / 20.0).round().max(1.0) as u32;
    for tx in 0..tiles {
        for ty in 0..tiles {
            let mut r = 12345u64 + u64::from(tx * 1000 + ty);
            let mut next = || {
                r = r
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                (r >> 33) as f64 / 2f64.powi(31)
            };
            for k in 0..30 {
                let x = (f64::from(tx) + next()) * 20.0;
                let y = (f64::from(ty) + next()) * 20.0;
                let s = 0.2 + 0.3 * next();
                if k < 20 {
                    solids.push(Solid::Disc(Disc {
                        centre: Point { x, y },
                        radius_m: s,
                    }));
                } else {
                    solids.push(Solid::Polygon(
                        Polygon::new(&[
                            Point { x: x - s, y: y - s },
                            Point { x: x + s, y: y - s },
                            Point { x: x + s, y: y + s },
                            Point { x: x - s, y: y + s },
                        ])
                        .unwrap(),
                    ));
                }
            }
        }
    }
    let t = Instant::now();
    let scenario = Arc::new(Scenario::new(&spec, solids, Vec::new()));
    eprintln!("scenario {:?}", t.elapsed());
    let t = Instant::now();
    let mut simulation = Simulation::new(scenario, 1, 0).unwrap();
    eprintln!("start {:?}", t.elapsed());
    let mut steps = 0;
    for _ in 0..20 {
        simulation.step();
    }
    let t = Instant::now();
    let c = cpu_s();
    while t.elapsed().as_secs_f64() < 2.0 {
        simulation.step();
        steps += 1;
    }
    let s = cpu_s() - c;
    println!(
        "{robots} robots: {:.2} M updates/s ({steps} steps) {:?}",
        f64::from(steps) * f64::from(robots) / s / 1e6,
        simulation.outcome()
    );
}
