use super::*;
use crate::scenario::{Scenario, ScenarioSpec};
use crate::simulation::Simulation;
use crate::world::obstacles::Solid;
use crate::world::static_geometry::{StaticGeometry, Wall};
use base::geometry::{Disc, Point, Segment};
use base::noise::Noise;
use base::random::Entity;
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

const RANGE_M: f64 = 5.0;

fn spec(rays: u32) -> RangeSpec {
    RangeSpec {
        rays,
        fov_deg: 360.0,
        facing_deg: 0.0,
        range_m: RANGE_M,
        noise_m: 0.0,
        relative_noise: 0.0,
        miss_probability: 0.0,
        spurious_return_probability: 0.0,
    }
}

/// Ranges of many measurements of one ray with a wall at a distance ahead.
fn measurements(spec: &RangeSpec, wall_m: f64, count: u64) -> Vec<f64> {
    let size_m = Point { x: 10.0, y: 10.0 };
    let segment = Segment {
        from: [wall_m, -5.0].into(),
        to: [wall_m, 5.0].into(),
    };
    let walls: Vec<Wall> = Wall::of(&segment).into_iter().collect();
    let geometry = StaticGeometry::new(size_m, &walls, &[], RANGE_M);
    let ring = Ring::new(spec);
    let mut buffers = RingBuffers::default();
    buffers.near.begin(Point::default(), RANGE_M);
    buffers.near.take_walls(walls.iter());
    let mut ranges_m = Vec::new();
    let measurement = |measurement| {
        let frame = SensorFrame {
            at: Point::default(),
            front: Point { x: 1.0, y: 0.0 },
            noise: Noise::of(3, 0, Entity { kind: 0, index: 0 }),
            sensor: 2,
            measurement,
            geometry: &geometry,
            is_clear: false,
        };
        ring.distances(&frame, &mut buffers, &mut ranges_m);
        ranges_m.clone()
    };
    (0..count).flat_map(measurement).collect()
}

/// The share of values that fulfil a condition is as expected, within five standard errors: wrong
/// for a right program less than once in a million; the seed is fixed.
fn assert_share(values: &[f64], expected: f64, is_one: impl Fn(f64) -> bool) {
    let count = values.len() as f64;
    let share = values.iter().filter(|value| is_one(**value)).count() as f64 / count;
    let error = (expected * (1.0 - expected) / count).sqrt();
    assert!(
        (share - expected).abs() <= 5.0 * error,
        "{share} {expected}"
    );
}

#[test]
fn a_whole_circle_has_its_first_ray_ahead_and_none_twice() {
    let degrees = |spec: &RangeSpec| {
        let bearings = bearings(spec);
        bearings
            .iter()
            .map(|rad| (rad.to_degrees() * 1e6).round() / 1e6)
            .collect::<Vec<_>>()
    };
    assert_eq!(degrees(&spec(4)), [0.0, 90.0, 180.0, -90.0]);
    let facing = |facing_deg, fov_deg, rays| RangeSpec {
        fov_deg,
        facing_deg,
        ..spec(rays)
    };
    assert_eq!(degrees(&facing(90.0, 360.0, 3)), [90.0, -150.0, -30.0]);
    // A sector has a ray on each edge; one ray is in its middle.
    assert_eq!(degrees(&facing(0.0, 90.0, 3)), [-45.0, 0.0, 45.0]);
    assert_eq!(degrees(&facing(170.0, 40.0, 3)), [150.0, 170.0, -170.0]);
    assert_eq!(degrees(&facing(-90.0, 270.0, 1)), [-90.0]);
    assert_eq!(degrees(&facing(10.0, 0.0, 2)), [10.0, 10.0]);
    let all = bearings(&facing(180.0, 359.0, 1440));
    assert!(all.iter().all(|bearing| bearing.abs() <= PI + 1e-12));
}

#[test]
fn nothing_at_the_range_or_farther_gives_an_echo() {
    let ray = |wall_m| measurements(&spec(1), wall_m, 1)[0];
    assert_eq!(ray(4.999), 4.999);
    assert_eq!(ray(RANGE_M), f64::INFINITY);
    assert_eq!(ray(6.0), f64::INFINITY);
    let noisy = RangeSpec {
        noise_m: 1.0,
        relative_noise: 0.5,
        ..spec(1)
    };
    // Noise brings back no echo of what is out of range.
    assert!(
        measurements(&noisy, 5.001, 2000)
            .iter()
            .all(|range| range.is_infinite())
    );
}

#[test]
fn noise_has_the_configured_moments() {
    let noisy = RangeSpec {
        noise_m: 0.1,
        relative_noise: 0.05,
        ..spec(1)
    };
    let values = measurements(&noisy, 2.0, 200_000);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / count;
    // A standard deviation of 0.1 and of 5 % of 2 m; five standard errors, as above.
    assert!((mean - 2.0).abs() < 5.0 * 0.2 / count.sqrt(), "{mean}");
    assert!(
        (variance / 0.04 - 1.0).abs() < 5.0 * (2.0 / count).sqrt(),
        "{variance}"
    );
    assert_share(&values, 0.158_655_254, |value| value > 2.2);
}

#[test]
fn errors_of_neighbouring_rays_and_of_looks_in_a_row_are_independent() {
    let noisy = RangeSpec {
        noise_m: 0.1,
        fov_deg: 1e-6,
        ..spec(4)
    };
    let values = measurements(&noisy, 2.0, 50_000);
    let deviation = |value: &f64| (value - 2.0) / 0.1;
    for lag in 1..=8 {
        let pairs = values.iter().zip(&values[lag..]);
        let products: Vec<f64> = pairs.map(|(a, b)| deviation(a) * deviation(b)).collect();
        let count = products.len() as f64;
        let correlation = products.iter().sum::<f64>() / count;
        // Eight of five standard errors: wrong less than once in 200,000.
        assert!(
            correlation.abs() < 5.0 / count.sqrt(),
            "{lag}: {correlation}"
        );
    }
}

#[test]
fn a_distance_is_never_below_0() {
    let noisy = RangeSpec {
        noise_m: 1.0,
        ..spec(1)
    };
    let values = measurements(&noisy, 0.1, 20_000);
    assert!(values.iter().all(|value| *value >= 0.0));
    // Of a normal error of 1 m, below -0.1 m.
    assert_share(&values, 0.460_172_163, |value| value == 0.0);
}

#[test]
fn returns_are_missed_and_spurious_with_the_configured_probabilities() {
    let false_and_lost = RangeSpec {
        miss_probability: 0.1,
        spurious_return_probability: 0.2,
        ..spec(1)
    };
    let values = measurements(&false_and_lost, 3.0, 100_000);
    assert_share(&values, 0.1, f64::is_infinite);
    assert_share(&values, 0.7, |value| value == 3.0);
    // A false echo is at any distance up to what is there.
    assert_share(&values, 0.1, |value| value < 1.5);
    assert_share(&values, 0.02, |value| (2.7..3.0).contains(&value));
    // Where there is nothing, up to the range.
    let values = measurements(&false_and_lost, 9.0, 100_000);
    assert_share(&values, 0.8, f64::is_infinite);
    assert_share(&values, 0.1, |value| value < 2.5);
}

#[test]
fn what_is_always_lost_is_never_measured_and_what_never_is_always() {
    let always = RangeSpec {
        miss_probability: 1.0,
        spurious_return_probability: 1.0,
        noise_m: 0.1,
        ..spec(1)
    };
    assert!(
        measurements(&always, 3.0, 1000)
            .iter()
            .all(|value| value.is_infinite())
    );
    assert!(
        measurements(&spec(1), 3.0, 1000)
            .iter()
            .all(|value| *value == 3.0)
    );
}

#[test]
fn rays_of_a_turned_robot_are_turned_with_it() {
    let disc = Disc {
        centre: Point { x: 0.0, y: 2.0 },
        radius_m: 0.5,
    };
    let mut buffers = RingBuffers::default();
    buffers.near.begin(Point::default(), RANGE_M);
    buffers.near.take_apart([disc].into_iter());
    let ring = Ring::new(&spec(4));
    let geometry = StaticGeometry::new(Point { x: 10.0, y: 10.0 }, &[], &[disc], RANGE_M);
    let measurement = |heading_rad: f64| {
        let (y, x) = base::trig::sin_cos(heading_rad);
        let frame = SensorFrame {
            at: Point::default(),
            front: Point { x, y },
            noise: Noise::of(3, 0, Entity { kind: 0, index: 0 }),
            sensor: 0,
            measurement: 0,
            geometry: &geometry,
            is_clear: false,
        };
        let mut ranges_m = Vec::new();
        ring.distances(&frame, &mut buffers, &mut ranges_m);
        ranges_m.iter().position(|range_m| range_m.is_finite())
    };
    // The disc is to the left, ahead, behind, and to the right.
    assert_eq!(
        [0.0, FRAC_PI_2, -FRAC_PI_2, PI].map(measurement),
        [Some(1), Some(0), Some(2), Some(3)]
    );
}

/// All features of a scan, in each instruction set of this machine.
#[test]
fn a_measurement_gives_the_same_bits_in_every_instruction_set() {
    let mut everything = RangeSpec {
        noise_m: 0.1,
        relative_noise: 0.05,
        miss_probability: 0.1,
        spurious_return_probability: 0.1,
        ..spec(1)
    };
    let room = base::geometry::Rectangle::spanned([-3.0, -2.0].into(), [4.0, 3.0].into()).room();
    let walls: Vec<Wall> = room.iter().filter_map(Wall::of).collect();
    let discs: Vec<Disc> = (1..9_i8)
        .map(|number| Disc {
            centre: Point {
                x: f64::from(number) / 3.0 - 1.6,
                y: f64::from(number * number % 7) / 2.0 - 1.4,
            },
            radius_m: 0.2,
        })
        .collect();
    let geometry = StaticGeometry::new(Point { x: 10.0, y: 10.0 }, &walls, &discs, RANGE_M);
    for (rays, measurement) in (1..=100).zip(0..) {
        everything.rays = rays;
        let ring = Ring::new(&everything);
        let (y, x) = base::trig::sin_cos(f64::from(rays));
        let frame = SensorFrame {
            at: Point::default(),
            front: Point { x, y },
            noise: Noise::of(3, 0, Entity { kind: 0, index: 0 }),
            sensor: 2,
            measurement,
            geometry: &geometry,
            is_clear: false,
        };
        let in_set = |arch: Arch| -> Vec<u64> {
            let (mut buffers, mut ranges_m) = (RingBuffers::default(), Vec::new());
            buffers.near.begin(frame.at, RANGE_M);
            buffers.near.take_overlapping(discs.iter().copied());
            buffers.near.take_walls(walls.iter());
            ring.look_with(arch, &frame, &mut buffers, &mut ranges_m);
            ranges_m.iter().map(|range_m| range_m.to_bits()).collect()
        };
        let plain = in_set(Arch::Scalar);
        for arch in instruction_sets() {
            assert_eq!(in_set(arch), plain, "{arch:?}, {rays} rays");
        }
    }
}

thread_local! {
    static INSTRUCTION_SET: Cell<Arch> = Cell::new(Arch::new());
}

/// Scratch memory of the measurements.
pub(crate) fn instruction_set() -> Arch {
    INSTRUCTION_SET.get()
}

/// Does something with what an instruction set has.
pub(crate) fn with_set<T>(arch: Arch, work: impl FnOnce() -> T) -> T {
    INSTRUCTION_SET.set(arch);
    let done = work();
    INSTRUCTION_SET.set(Arch::new());
    done
}

#[test]
fn a_run_has_the_same_bits_in_every_instruction_set() {
    let spec = serde_json::json!({
        "clock": {"time_limit_s": 1e4},
        "world": {"size_m": [12, 9]},
        "robots": {"rover": {
            "count": 30,
            "radius_m": 0.2,
            "drive": {"max_speed_m_s": 1.0, "max_turn_rate_deg_s": 90},
            "sensors": {
                "lidar": {"kind": "range", "rays": 55, "fov_deg": 270, "range_m": 10,
                    "noise_m": 0.02, "relative_noise": 0.01, "miss_probability": 0.01, "spurious_return_probability": 0.01},
                "sonar": {"kind": "range", "rays": 16, "range_m": 3, "rate_hz": 4},
            },
        }},
    });
    let spec: ScenarioSpec = serde_json::from_value(spec).unwrap();
    let solids = vec![Solid::Disc(Disc {
        centre: Point { x: 3.0, y: 4.0 },
        radius_m: 0.7,
    })];
    let scenario = Arc::new(Scenario::new(&spec, solids, Vec::new()));
    let hashes = |arch| {
        INSTRUCTION_SET.set(arch);
        let mut simulation = Simulation::new(Arc::clone(&scenario), 3, 4).unwrap();
        let step = |_| {
            simulation.step();
            simulation.state().hash()
        };
        (0..500).map(step).collect::<Vec<u64>>()
    };
    let plain = hashes(Arch::Scalar);
    for arch in instruction_sets() {
        assert!(hashes(arch) == plain, "{arch:?}");
    }
    assert!(plain.windows(2).all(|pair| pair[0] != pair[1]));
}

pub(crate) fn instruction_sets() -> Vec<Arch> {
    #[cfg(target_arch = "x86_64")]
    let wide = [
        pulp::x86::V3::try_new().map(Arch::V3),
        pulp::x86::V4::try_new().map(Arch::V4),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let wide = [Some(Arch::new())];
    wide.into_iter().flatten().collect()
}
