//! The order of a flock decreases with noise as in T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen and
//! O. Shochet, *Novel type of phase transition in a system of self-driven particles*, Physical
//! Review Letters 75 (1995), figure 2.

use crate::rows::{Row, SIGMAS, assert_published, assert_right, assert_wrong};
use crate::setup::{Random, list, run, scenario, whole};
use base::document::Value;
use base::geometry::{Point, Torus};
use base::trig::sin_cos;
use std::f64::consts::{PI, TAU};

const TEXT: &str = include_str!("../../../../docs/validation/vicsek.toml");

/// Interaction radius of the paper, in its unit.
const PER_M: f64 = 0.1;
const DENSITY: f64 = 4.0;
const STEP: f64 = 0.03;

/// Widths of the noise in radians: those of the paper's figure, and a full turn.
const NOISES: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0];

/// Steps until the order has settled, and steps over which it is averaged.
const BEFORE: u32 = 150;
const STEPS: u32 = 250;

const RUNS: u64 = 40;

/// The paper's order parameter: the length of the mean of unit vectors along the courses.
fn order(courses: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (Point::default(), 0.0);
    for course_rad in courses {
        let (y, x) = sin_cos(course_rad);
        sum = sum.plus(Point { x, y });
        count += 1.0;
    }
    sum.length() / count
}

/// The mean order of each run, from `steps` that give the order after each.
fn mean_order(mut step: impl FnMut() -> f64) -> f64 {
    (0..BEFORE).for_each(|_| {
        step();
    });
    (0..STEPS).map(|_| step()).sum::<f64>() / f64::from(STEPS)
}

/// Results of the simulator.
fn simulated(particles: u32, noise_rad: f64) -> Vec<f64> {
    let side_m = (f64::from(particles) / DENSITY).sqrt() / PER_M;
    let noise = format!("noise_deg = {}", noise_rad.to_degrees());
    let scenario = scenario(
        &TEXT.replace("noise_deg = 60", &noise),
        &[
            ("robots.particle.count", whole(particles)),
            ("world.size_m", list([side_m; 2].map(Value::Float))),
        ],
    );
    let order_of = |number| {
        let mut simulation = run(&scenario, 1, number);
        mean_order(|| {
            simulation.step();
            let robots = simulation.state().each_robot(&scenario);
            order(robots.map(|robot| robot.heading_rad))
        })
    };
    (0..RUNS).map(order_of).collect()
}

/// The paper's rule, computed pair by pair in its unit with separate random numbers: each particle
/// takes the mean course of all within a distance of 1, including itself, and moves along it.
fn direct(particles: u32, noise_rad: f64) -> Vec<f64> {
    let side = (f64::from(particles) / DENSITY).sqrt();
    let torus = Torus {
        size_m: Point { x: side, y: side },
    };
    let order_of = |number| {
        let mut random = Random::of_run(number);
        let mut places: Vec<Point> = (0..particles)
            .map(|_| Point {
                x: side * random.unit(),
                y: side * random.unit(),
            })
            .collect();
        let mut courses: Vec<f64> = (0..particles).map(|_| TAU * random.unit() - PI).collect();
        mean_order(|| {
            courses = turned(&places, &courses, side);
            for (place, course) in places.iter_mut().zip(&mut courses) {
                *course += noise_rad * (random.unit() - 0.5);
                let (y, x) = sin_cos(*course);
                *place = torus.home(place.plus(Point { x, y }.times(STEP)));
            }
            order(courses.iter().copied())
        })
    };
    (0..RUNS).map(order_of).collect()
}

/// The mean course around each particle of a square that wraps.
fn turned(places: &[Point], courses: &[f64], side: f64) -> Vec<f64> {
    let apart = |one: f64, other: f64| (one - other).abs().min(side - (one - other).abs());
    let way = |course: &f64| {
        let (y, x) = sin_cos(*course);
        Point { x, y }
    };
    let ways: Vec<Point> = courses.iter().map(way).collect();
    let mut sums = vec![Point::default(); ways.len()];
    for (one, place) in places.iter().enumerate() {
        sums[one] = sums[one].plus(ways[one]);
        for (other, there) in places.iter().enumerate().skip(one + 1) {
            let [x, y] = [apart(place.x, there.x), apart(place.y, there.y)];
            if x * x + y * y <= 1.0 {
                sums[one] = sums[one].plus(ways[other]);
                sums[other] = sums[other].plus(ways[one]);
            }
        }
    }
    sums.iter().map(|sum| libm::atan2(sum.y, sum.x)).collect()
}

/// Independent courses form a random walk in the plane: Rayleigh's law with its next term (K. V.
/// Mardia and P. E. Jupp, *Directional Statistics*, 2000, section 4.8).
fn of_independent(particles: u32) -> f64 {
    let count = f64::from(particles);
    (PI / count).sqrt() / 2.0 * (1.0 + 1.0 / (16.0 * count))
}

/// The simulator's result compared with the direct computation; both have standard errors.
fn beside(particles: u32, simulated: &[f64], noise_rad: f64) -> Row {
    let expected = Row::mean("", 0.0, &direct(particles, noise_rad), None);
    let row = Row::mean(
        &format!("{particles} robots"),
        noise_rad,
        simulated,
        Some(expected.measured),
    );
    Row {
        error: row.error.hypot(expected.error),
        ..row
    }
}

fn without_order(particles: u32) -> Row {
    let series = format!("{particles} robots of any course");
    let expected = Some(of_independent(particles));
    Row::mean(&series, TAU, &simulated(particles, TAU), expected)
}

#[test]
fn the_order_of_a_flock_decreases_with_noise_as_vicsek_reports() {
    let mut rows = Vec::new();
    for particles in [40, 100] {
        let row = |noise: &f64| beside(particles, &simulated(particles, *noise), *noise);
        rows.extend(NOISES.iter().map(row));
    }
    let falls = |pair: &[Row]| {
        let error = pair[0].error.hypot(pair[1].error);
        pair[0].series != pair[1].series || pair[0].measured - pair[1].measured > SIGMAS * error
    };
    assert!(rows.windows(2).all(falls), "{rows:#?}");
    let many = |noise: &f64| Row::mean("400 robots", *noise, &simulated(400, *noise), None);
    rows.extend(NOISES.iter().map(many));
    rows.extend([40, 100, 400].map(without_order));
    assert_right(&rows);
    assert_published("vicsek.csv", &rows);
}

#[test]
fn noise_5_percent_too_wide_is_detected() {
    let row = |noise: &f64| beside(40, &simulated(40, 1.05 * *noise), *noise);
    assert_wrong(&NOISES.iter().map(row).collect::<Vec<Row>>());
}
